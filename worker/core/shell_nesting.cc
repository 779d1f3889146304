#include "core/shell_nesting.h"

#include <algorithm>
#include <array>

namespace affskel::core {
namespace {

struct Shape {
  std::array<std::uint32_t, 6> extreme{};  // vertices with the least and greatest x, y, z
  std::vector<std::uint32_t> triangles;
};

// Whether the edge a-b, seen along z, crosses the line from q towards +x (half-open in y, ends compared
// exactly; the side of q is computed the same way from both triangles of the edge).
bool crosses(const Vec3& a, const Vec3& b, const Vec3& q) {
  if ((a.y <= q.y) == (b.y <= q.y)) return false;
  const Vec3 &low = a.y < b.y ? a : b, &high = a.y < b.y ? b : a;
  return low.x + (q.y - low.y) / (high.y - low.y) * (high.x - low.x) > q.x;
}

double height_above(const Mesh& mesh, const Triangle& t, const Vec3& q) {
  const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
  const Vec3 n = cross(b - a, c - a);
  return n.z == 0 ? a.z - q.z : a.z - ((q.x - a.x) * n.x + (q.y - a.y) * n.y) / n.z - q.z;
}

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
      bool covers = false;
      for (std::size_t i = 0; i < 3; ++i) {
        covers ^= crosses(mesh_.points[corner[i]], mesh_.points[corner[(i + 1) % 3]], q);
      }
      if (covers && height_above(mesh_, corner, q) > 0) odd = !odd;
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
