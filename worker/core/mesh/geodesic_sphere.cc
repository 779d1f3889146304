#include "core/mesh/geodesic_sphere.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "core/base/unit.h"

namespace affskel::core {
namespace {

// Hands out one vertex per lattice point of the subdivided faces, shared along edges and at corners.
// A lattice point is named by its barycentric weights with respect to the coarse corners.
class GeodesicVertices {
 public:
  GeodesicVertices(const Mesh& coarse, std::uint32_t frequency, Mesh& out)
      : coarse_(coarse), frequency_(frequency), out_(out) {}

  // Vertex at weights (f - i - j, i, j) of coarse triangle `face`.
  std::uint32_t at(std::size_t face, std::uint32_t i, std::uint32_t j) {
    const Triangle& t = coarse_.triangles[face];
    const std::array<std::uint32_t, 3> weight{frequency_ - i - j, i, j};
    std::array<std::pair<std::uint32_t, std::uint32_t>, 3> corner;  // (corner, weight)
    std::size_t used = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (weight[k] > 0) corner[used++] = {t[k], weight[k]};
    }
    // In order of the corner's index, so that both faces at an edge compute the same key and point.
    if (used < 3) std::sort(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(used));
    const std::uint64_t name = used == 3 ? 0x8000 | face : (corner[0].first << 8) | corner[used - 1].first;
    const std::uint64_t key =
        (name << 48) | (std::uint64_t{corner[0].second} << 24) | corner[used - 1].second;
    const auto [place, is_new] = vertex_.try_emplace(key, 0);
    if (is_new) place->second = add(corner, used);
    return place->second;
  }

 private:
  std::uint32_t add(const std::array<std::pair<std::uint32_t, std::uint32_t>, 3>& corner, std::size_t used) {
    Vec3 sum;
    for (std::size_t k = 0; k < used; ++k) sum = sum + corner[k].second * coarse_.points[corner[k].first];
    out_.points.push_back(unit(sum));
    return static_cast<std::uint32_t>(out_.points.size() - 1);
  }

  const Mesh& coarse_;
  std::uint32_t frequency_;
  Mesh& out_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_;
};

}  // namespace

Mesh icosahedron() {
  constexpr double g = std::numbers::phi;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

Mesh geodesic_sphere(std::uint32_t frequency) {
  const Mesh coarse = icosahedron();
  Mesh mesh;
  GeodesicVertices vertices(coarse, frequency, mesh);
  for (std::size_t face = 0; face < coarse.triangles.size(); ++face) {
    for (std::uint32_t i = 0; i < frequency; ++i) {
      for (std::uint32_t j = 0; i + j < frequency; ++j) {
        const std::uint32_t right = vertices.at(face, i + 1, j);
        const std::uint32_t up = vertices.at(face, i, j + 1);
        mesh.triangles.push_back({vertices.at(face, i, j), right, up});
        if (i + j + 1 < frequency) mesh.triangles.push_back({right, vertices.at(face, i + 1, j + 1), up});
      }
    }
  }
  return mesh;
}

}  // namespace affskel::core
