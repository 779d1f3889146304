#include "client/base/spots.h"

#include "core/mesh/box.h"

namespace affskel::client {

core::DisjointSets pieces_of(const v1::TriangleMesh& sheet) {
  core::DisjointSets pieces(static_cast<std::size_t>(sheet.xyz_size() / 3));
  for (int i = 0; i < sheet.corners_size(); i += 3) {
    pieces.unite(sheet.corners(i), sheet.corners(i + 1));
    pieces.unite(sheet.corners(i), sheet.corners(i + 2));
  }
  for (int i = 0; i < sheet.segments_size(); i += 2) pieces.unite(sheet.segments(i), sheet.segments(i + 1));
  return pieces;
}

core::Vec3 vertex_of(const v1::TriangleMesh& sheet, std::uint32_t v) {
  const int first = 3 * static_cast<int>(v);
  return {sheet.xyz(first), sheet.xyz(first + 1), sheet.xyz(first + 2)};
}

std::vector<std::uint32_t> spots_of(const v1::TriangleMesh& sheet, double size) {
  core::DisjointSets pieces = pieces_of(sheet);
  std::vector<core::Box> boxes(static_cast<std::size_t>(sheet.xyz_size() / 3));
  for (std::uint32_t v = 0; v < boxes.size(); ++v) boxes[pieces.find(v)].include(vertex_of(sheet, v));
  std::vector<std::uint32_t> spots;
  for (std::uint32_t v = 0; v < boxes.size(); ++v)
    if (pieces.find(v) == v && boxes[v].longest_side() < size) spots.push_back(v);
  return spots;
}

}  // namespace affskel::client
