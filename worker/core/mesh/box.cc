#include "core/mesh/box.h"

namespace affskel::core {

std::size_t Box::longest_axis() const {
  const Vec3 side = sides();
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (side[k] > side[longest]) longest = k;
  return longest;
}

Box box_of(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& p : points) box.include(p);
  return box;
}

Box box_of(std::span<const Vec3> points, const Matrix3& axes) {
  Box box;
  for (const Vec3& p : points) box.include(transposed_times(axes, p));
  return box;
}

Box box_of(const Mesh& mesh, const Triangle& triangle) {
  Box box;
  for (const std::uint32_t corner : triangle) box.include(mesh.points[corner]);
  return box;
}

Box box_of(const Mesh& mesh) {
  Box box;
  for (const Triangle& t : mesh.triangles) box.include(box_of(mesh, t));
  return box;
}

double box_diagonal(const Mesh& mesh) {
  if (mesh.points.empty()) return 0;
  return (mesh.triangles.empty() ? box_of(mesh.points) : box_of(mesh)).diagonal();
}

std::vector<Box> boxes_of(const Mesh& mesh) {
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) boxes.push_back(box_of(mesh, t));
  return boxes;
}

}  // namespace affskel::core
