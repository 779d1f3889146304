#include "core/shocks.h"

#include <array>

#include "core/field.h"
#include "core/slab_index.h"

namespace affskel::core {
namespace {

class Divergence {
 public:
  Divergence(const Lattice& lattice, const DirectionSet& directions, const OptimalDirections& optimal,
             const ZuckerHummelOptions& options)
      : lattice_(lattice), directions_(directions), optimal_(optimal), slabs_(lattice) {
    weight_ = {options.face_weight, options.edge_weight, options.corner_weight};
  }

  std::vector<double> run() {
    std::vector<double> result(lattice_.points, 0);
    std::uint32_t reached = SlabIndex::kOutside;
    for (const LatticeRun& run : lattice_.axis[2].runs) {
      while (reached != run.start[0]) slabs_.move_to(++reached);
      for (std::uint32_t n = 0; n < run.length; ++n) {
        result[run.first + n] =
            at({run.start[0], run.start[1], std::int64_t{run.start[2]} + n}, run.first + n);
      }
    }
    return result;
  }

 private:
  Vec3 normal(std::uint32_t point) const {
    const std::uint32_t direction = optimal_[point];
    return direction == FieldValue::kNoDirection ? Vec3{} : directions_[direction];
  }

  Vec3 neighbour(const std::array<std::int64_t, 3>& at, const std::array<int, 3>& step,
                 const Vec3& centre) const {
    const std::uint32_t p = slabs_.at(at[0] + step[0], at[1] + step[1], at[2] + step[2]);
    return p == SlabIndex::kOutside ? centre : normal(p);
  }

  double at(const std::array<std::int64_t, 3>& place, std::uint32_t point) const {
    const Vec3 centre = normal(point);
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
      double derivative = 0;
      for (int u = -1; u <= 1; ++u) {
        for (int v = -1; v <= 1; ++v) {
          std::array<int, 3> step{};
          step[static_cast<std::size_t>((a + 1) % 3)] = u;
          step[static_cast<std::size_t>((a + 2) % 3)] = v;
          step[static_cast<std::size_t>(a)] = 1;
          const double ahead = neighbour(place, step, centre)[a];
          step[static_cast<std::size_t>(a)] = -1;
          const double behind = neighbour(place, step, centre)[a];
          derivative += weight_[static_cast<std::size_t>(u * u + v * v)] * (ahead - behind);
        }
      }
      sum += derivative;
    }
    return sum;
  }

  const Lattice& lattice_;
  const DirectionSet& directions_;
  const OptimalDirections& optimal_;
  SlabIndex slabs_;
  std::array<double, 3> weight_{};
};

}  // namespace

std::vector<double> zucker_hummel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                             const OptimalDirections& optimal,
                                             const ZuckerHummelOptions& options) {
  return Divergence(lattice, directions, optimal, options).run();
}

}  // namespace affskel::core
