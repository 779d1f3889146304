#include "client/view/sheet_pieces.h"

#include <algorithm>

#include "core/base/disjoint_sets.h"
#include "core/base/vec3.h"

namespace affskel::client {
namespace {

using core::Vec3;

Vec3 vertex(const v1::TriangleMesh& sheet, std::uint32_t v) {
  const int first = 3 * static_cast<int>(v);
  return {sheet.xyz(first), sheet.xyz(first + 1), sheet.xyz(first + 2)};
}

double weight(const v1::TriangleMesh& sheet, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vec3 at = vertex(sheet, a);
  const double area = 0.5 * core::norm(core::cross(vertex(sheet, b) - at, vertex(sheet, c) - at));
  const auto strength = [&](std::uint32_t v) { return sheet.strength(static_cast<int>(v)); };
  return area * ((strength(a) + strength(b)) + strength(c)) / 3;
}

}  // namespace

SheetPieces sheet_pieces(const v1::TriangleMesh& sheet) {
  const auto& corners = sheet.corners();
  const int triangles = corners.size() / 3;
  core::DisjointSets vertices(static_cast<std::size_t>(sheet.xyz_size() / 3));
  for (int t = 0; t < triangles; ++t) {
    vertices.unite(corners[3 * t], corners[3 * t + 1]);
    vertices.unite(corners[3 * t], corners[3 * t + 2]);
  }
  std::vector<double> weights(static_cast<std::size_t>(sheet.xyz_size() / 3), 0);  // by the vertex of a set
  std::vector<std::uint32_t> roots;
  double whole = 0;
  for (int t = 0; t < triangles; ++t) {
    const std::uint32_t root = vertices.find(corners[3 * t]);
    const double w = weight(sheet, corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]);
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
    pieces.shares.push_back(whole > 0 ? weights[heaviest[p]] / whole : 0);
  }
  for (const std::uint32_t root : roots) pieces.piece.push_back(number[root]);
  return pieces;
}

}  // namespace affskel::client
