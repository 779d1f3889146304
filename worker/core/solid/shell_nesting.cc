#include "core/solid/shell_nesting.h"

#include <algorithm>
#include <array>

#include "core/spatial/ray_crossing.h"

namespace affskel::core {
namespace {

struct Shape {
  std::array<std::uint32_t, 6> extreme{};  // vertices with the least and greatest x, y, z
  std::vector<std::uint32_t> triangles;
};

class Nester {
 public:
  Nester(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell, std::uint32_t shells)
      : mesh_(mesh), shapes_(shells) {
    for (std::uint32_t t = 0; t < triangle_shell.size(); ++t) add(shapes_[triangle_shell[t]], t);
  }

  ShellNesting run() const {
    const std::size_t count = shapes_.size();
    ShellNesting nesting{std::vector<std::uint32_t>(count, 0),
                         std::vector<std::uint32_t>(count, ShellNesting::kNone)};
    std::vector<std::vector<std::uint32_t>> around(count);
    for (std::uint32_t inner = 0; inner < count; ++inner) {
      for (std::uint32_t outer = 0; outer < count; ++outer) {
        if (inner != outer && contains(shapes_[outer], shapes_[inner])) around[inner].push_back(outer);
      }
      nesting.depth[inner] = static_cast<std::uint32_t>(around[inner].size());
    }
    for (std::uint32_t inner = 0; inner < count; ++inner) {
      for (std::uint32_t outer : around[inner]) {
        std::uint32_t& parent = nesting.parent[inner];
        if (parent == ShellNesting::kNone || nesting.depth[outer] > nesting.depth[parent]) parent = outer;
      }
    }
    return nesting;
  }

 private:
  void add(Shape& shape, std::uint32_t t) {
    if (shape.triangles.empty()) shape.extreme.fill(mesh_.triangles[t][0]);
    shape.triangles.push_back(t);
    for (std::uint32_t v : mesh_.triangles[t]) {
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& least = shape.extreme[static_cast<std::size_t>(2 * k)];
        std::uint32_t& most = shape.extreme[static_cast<std::size_t>(2 * k + 1)];
        if (mesh_.points[v][k] < mesh_.points[least][k]) least = v;
        if (mesh_.points[v][k] > mesh_.points[most][k]) most = v;
      }
    }
  }

  bool contains(const Shape& outer, const Shape& inner) const {
    for (int k = 0; k < 3; ++k) {
      const auto low = static_cast<std::size_t>(2 * k), high = low + 1;
      if (!(mesh_.points[outer.extreme[low]][k] < mesh_.points[inner.extreme[low]][k])) return false;
      if (!(mesh_.points[inner.extreme[high]][k] < mesh_.points[outer.extreme[high]][k])) return false;
    }
    return std::all_of(inner.extreme.begin(), inner.extreme.end(),
                       [&](std::uint32_t v) { return inside(outer, mesh_.points[v]); });
  }

  // Parity of the crossings of the ray from q towards +z.
  bool inside(const Shape& shape, const Vec3& q) const {
    bool odd = false;
    for (std::uint32_t t : shape.triangles) {
      const Triangle& corner = mesh_.triangles[t];
      const bool covers = winding_round_line(mesh_, corner, q, 2) != 0;
      if (covers && distance_along(mesh_, corner, q, 2) > 0) odd = !odd;
    }
    return odd;
  }

  const Mesh& mesh_;
  std::vector<Shape> shapes_;
};

}  // namespace

ShellNesting nest_shells(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                         std::uint32_t shells) {
  if (shells == 1) return {{0}, {ShellNesting::kNone}};
  return Nester(mesh, triangle_shell, shells).run();
}

}  // namespace affskel::core
