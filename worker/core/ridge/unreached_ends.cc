#include "core/ridge/unreached_ends.h"

#include <algorithm>
#include <cstddef>
#include <map>

#include "core/base/disjoint_sets.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/ridge/row_band.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

constexpr double kReached = 2;  // spacings: sample points so near tell of a corner's surroundings

class Ends {
 public:
  Ends(const Solid& solid, const Lattice& lattice, std::span<const char> left_out)
      : solid_(solid), indices_of_(lattice), points_(lattice), left_out_(left_out) {}

  std::vector<UnreachedEnd> run(std::span<const Vec3> skeleton, ExecutionContext* context) {
    StopCheck stop(context);
    const auto& points = solid_.mesh.points;
    std::vector<char> far(points.size());
    bool any = false;
    for (std::size_t p = 0; p < points.size(); ++p, stop.did(100)) {
      far[p] = !is_reached(indices_of_(points[p]));
      any = any || far[p] != 0;
    }
    if (!any) return {};
    DisjointSets pieces(points.size());
    for (const Triangle& corners : solid_.mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
        if (far[a] && far[b]) pieces.unite(a, b);
      }
    }
    const PointIndex index(skeleton);
    std::map<std::uint32_t, UnreachedEnd> ends;  // by piece
    for (std::uint32_t p = 0; p < points.size(); ++p, stop.did(100)) {
      if (!far[p]) continue;
      const Vec3 place = solid_.centre + solid_.scale() * points[p];
      UnreachedEnd& end = ends[pieces.find(p)];
      if (const double distance = index.nearest(place); distance > end.distance) end = {place, distance};
    }
    std::vector<UnreachedEnd> result;
    for (const auto& [piece, end] : ends) result.push_back(end);
    std::stable_sort(result.begin(), result.end(),
                     [](const UnreachedEnd& a, const UnreachedEnd& b) { return a.distance > b.distance; });
    return result;
  }

 private:
  // Whether a sample point that counts lies within kReached.
  bool is_reached(const Vec3& at) const {
    return points_.any_near(at, kReached, [&](std::uint32_t rank, double square) {
      return square <= kReached * kReached && left_out_[rank] == 0;
    });
  }

  const Solid& solid_;
  LatticeIndices indices_of_;
  NearPoints points_;
  std::span<const char> left_out_;  // per sample point: it has no skeleton
};

}  // namespace

std::vector<UnreachedEnd> unreached_ends(const Solid& solid, const Lattice& lattice,
                                         std::span<const char> left_out, std::span<const Vec3> skeleton,
                                         ExecutionContext* context) {
  return Ends(solid, lattice, left_out).run(skeleton, context);
}

}  // namespace affskel::core
