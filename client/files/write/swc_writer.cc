#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/number_text.h"
#include "client/files/write/curve_graph.h"
#include "client/files/write/shape_writers.h"
#include "client/text/printable.h"
#include "core/base/groups.h"

namespace affskel::client {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;

// Rows of trees, parents first.
class Trees {
 public:
  Trees(const ShapeFile& shape, const WriteBytes& write)
      : shape_(shape),
        write_(write),
        radius_(curve_column(shape, "radius")),
        neighbours_(shape.mesh().points.size(),
                    [&](const auto& put) {
                      for (const auto& [a, b] : shape.segments) {
                        put(a, b);
                        put(b, a);
                      }
                    }),
        row_(shape.mesh().points.size(), 0) {}

  void write_tree(std::uint32_t root) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> next{{root, kNone}};  // vertex, the one before
    while (!next.empty()) {
      const auto [v, before] = next.back();
      next.pop_back();
      if (row_[v] != 0) continue;  // a loop closes
      write_row(v, before);
      for (const std::uint32_t to : neighbours_[v])
        if (row_[to] == 0) next.push_back({to, v});
    }
  }

  bool has(std::uint32_t v) const { return row_[v] != 0; }

 private:
  void write_row(std::uint32_t v, std::uint32_t before) {
    constexpr const char* kUndefined = "0";  // the type: no soma, axon or dendrite
    const core::Vec3& at = shape_.mesh().points[v];
    row_[v] = ++rows_;
    write_(std::to_string(row_[v]) + " " + kUndefined + " " + base::to_text(at.x) + " " +
           base::to_text(at.y) + " " + base::to_text(at.z) + " " + base::to_text(radius_[v]) + " " +
           (before == kNone ? "-1" : std::to_string(row_[before])) + "\n");
  }

  const ShapeFile& shape_;
  const WriteBytes& write_;
  const std::vector<double>& radius_;
  core::Groups<std::uint32_t> neighbours_;
  std::vector<std::uint32_t> row_;  // per vertex, from 1; 0: not written yet
  std::uint32_t rows_ = 0;
};

}  // namespace

void write_swc(const ShapeFile& shape, const std::vector<std::string>& comments, const WriteBytes& write) {
  for (const std::string& comment : comments) write("# " + one_line(comment) + "\n");
  write("# id type x y z radius parent\n");
  const std::vector<double>& erosion = curve_column(shape, "E");
  std::vector<std::uint32_t> roots(erosion.size());
  for (std::uint32_t v = 0; v < roots.size(); ++v) roots[v] = v;
  std::stable_sort(roots.begin(), roots.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return erosion[a] > erosion[b]; });
  Trees trees(shape, write);
  for (const std::uint32_t root : roots)
    if (!trees.has(root)) trees.write_tree(root);
}

}  // namespace affskel::client
