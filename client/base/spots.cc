#include "client/base/spots.h"

#include <optional>

#include "client/base/mesh_box.h"
#include "core/base/disjoint_sets.h"

namespace affskel::client {
namespace {

core::DisjointSets pieces_of(const v1::TriangleMesh& sheet) {
  core::DisjointSets pieces(static_cast<std::size_t>(sheet.xyz_size() / 3));
  for (int i = 0; i < sheet.corners_size(); i += 3) {
    pieces.unite(sheet.corners(i), sheet.corners(i + 1));
    pieces.unite(sheet.corners(i), sheet.corners(i + 2));
  }
  for (int i = 0; i < sheet.segments_size(); i += 2) pieces.unite(sheet.segments(i), sheet.segments(i + 1));
  return pieces;
}

}  // namespace

std::vector<std::uint32_t> spots_of(const v1::TriangleMesh& sheet, double size) {
  core::DisjointSets pieces = pieces_of(sheet);
  std::vector<std::optional<Box>> boxes(static_cast<std::size_t>(sheet.xyz_size() / 3));
  for (std::uint32_t v = 0; v < boxes.size(); ++v) {
    const int first = 3 * static_cast<int>(v);
    const core::Vec3 at{sheet.xyz(first), sheet.xyz(first + 1), sheet.xyz(first + 2)};
    std::optional<Box>& box = boxes[pieces.find(v)];
    if (!box) box = Box{at, at};
    box->add(at);
  }
  std::vector<std::uint32_t> spots;
  for (std::uint32_t v = 0; v < boxes.size(); ++v)
    if (boxes[v] && boxes[v]->longest_side() < size) spots.push_back(v);
  return spots;
}

}  // namespace affskel::client
