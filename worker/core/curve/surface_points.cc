#include "core/curve/surface_points.h"

#include <cstddef>

#include "core/base/unit.h"
#include "core/collapse/dual_complex.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/ridge/row_band.h"

namespace affskel::core {
namespace {

constexpr std::int32_t kFarthest = 4;  // steps

class PointsOfLattice {
 public:
  explicit PointsOfLattice(const Lattice& lattice)
      : band_(lattice, 0), rank_(band_.places(), DualComplex::kNone) {
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      rank_[static_cast<std::size_t>(band_.at(i, j, k))] = rank;
    });
  }

  // @param at real indices.
  std::uint32_t nearest(const Vec3& at) const {
    for (std::int32_t reach = 1; reach <= kFarthest; reach *= 2)
      if (const std::uint32_t found = nearest_within(at, reach); found != DualComplex::kNone) return found;
    return DualComplex::kNone;
  }

 private:
  std::uint32_t nearest_within(const Vec3& at, std::int32_t reach) const {
    double least = double(reach) * reach;
    std::uint32_t found = DualComplex::kNone;
    band_.any_near(at, reach, [&](std::size_t place, double square) {
      const std::uint32_t rank = rank_[place];
      if (rank == DualComplex::kNone || square > least) return false;
      if (square == least && found != DualComplex::kNone) return false;
      least = square;
      found = rank;
      return false;
    });
    return found;
  }

  RowBand band_;
  std::vector<std::uint32_t> rank_;  // per place of the band
};

}  // namespace

std::vector<std::uint32_t> surface_points(const Solid& solid, const Lattice& lattice,
                                          ExecutionContext* context) {
  const PointsOfLattice points(lattice);
  const LatticeIndices indices(lattice);
  const double half_step = 0.5 * lattice.spacing / solid.scale();
  StopCheck stop(context);
  std::vector<std::uint32_t> result;
  result.reserve(solid.mesh.triangles.size());
  for (const auto& [a, b, c] : solid.mesh.triangles) {
    stop.did(100);
    const Vec3 &p = solid.mesh.points[a], &q = solid.mesh.points[b], &r = solid.mesh.points[c];
    const Vec3 outward = unit(cross(q - p, r - p));
    const Vec3 place = (1.0 / 3) * (p + (q + r)) - half_step * outward;
    result.push_back(points.nearest(indices(place)));
  }
  return result;
}

}  // namespace affskel::core
