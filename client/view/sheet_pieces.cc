#include "client/view/sheet_pieces.h"

#include <algorithm>
#include <span>

#include "client/base/spots.h"

namespace affskel::client {
namespace {

using core::Vec3;

double mean_strength(const v1::TriangleMesh& sheet, std::span<const std::uint32_t> element) {
  double sum = 0;
  for (const std::uint32_t v : element) sum += sheet.strength(static_cast<int>(v));
  return sum / static_cast<double>(element.size());
}

double weight(const v1::TriangleMesh& sheet, std::span<const std::uint32_t> element) {
  const Vec3 at = vertex_of(sheet, element[0]), along = vertex_of(sheet, element[1]) - at;
  const double area = element.size() == 2
                          ? core::dot(along, along)
                          : 0.5 * core::norm(core::cross(along, vertex_of(sheet, element[2]) - at));
  return area * mean_strength(sheet, element);
}

// The vertices of each triangle, then of each segment.
std::vector<std::span<const std::uint32_t>> elements_of(const v1::TriangleMesh& sheet) {
  std::vector<std::span<const std::uint32_t>> elements;
  for (int i = 0; i < sheet.corners_size(); i += 3) elements.push_back({sheet.corners().data() + i, 3});
  for (int i = 0; i < sheet.segments_size(); i += 2) elements.push_back({sheet.segments().data() + i, 2});
  return elements;
}

}  // namespace

SheetPieces sheet_pieces(const v1::TriangleMesh& sheet) {
  const auto elements = elements_of(sheet);
  core::DisjointSets vertices = pieces_of(sheet);
  std::vector<double> weights(static_cast<std::size_t>(sheet.xyz_size() / 3), 0);  // by the vertex of a set
  std::vector<std::uint32_t> roots;
  double whole = 0;
  for (const auto& element : elements) {
    const std::uint32_t root = vertices.find(element[0]);
    const double w = weight(sheet, element);
    weights[root] += w;
    whole += w;
    roots.push_back(root);
  }
  std::vector<std::uint32_t> heaviest = roots;
  std::sort(heaviest.begin(), heaviest.end());
  heaviest.erase(std::unique(heaviest.begin(), heaviest.end()), heaviest.end());
  std::stable_sort(heaviest.begin(), heaviest.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return weights[a] > weights[b]; });
  SheetPieces pieces;
  std::vector<std::uint32_t> number(weights.size(), 0);
  for (std::size_t p = 0; p < heaviest.size(); ++p) {
    number[heaviest[p]] = static_cast<std::uint32_t>(p);
    // Ways have no strength: where there is nothing else, all pieces count alike.
    pieces.shares.push_back(whole > 0 ? weights[heaviest[p]] / whole : 1);
  }
  for (const std::uint32_t root : roots) pieces.piece.push_back(number[root]);
  return pieces;
}

}  // namespace affskel::client
