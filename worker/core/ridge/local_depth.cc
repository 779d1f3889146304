#include "core/ridge/local_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "core/base/unit.h"
#include "core/lattice/lattice_edges.h"
#include "core/ridge/row_band.h"

namespace affskel::core {
namespace {

// E / |g| for gradients whose squares may leave the range of a double.
double depth(double erosion, const Vec3& g) {
  const Vec3 near = scaled_to_unit(g);
  return norm(near) > 0 ? std::ldexp(erosion / norm(near), -largest_exponent(g)) : 0;
}

class Relaxation {
 public:
  Relaxation(const Lattice& lattice, std::vector<float> depth)
      : lattice_(lattice), band_(lattice, 0), rank_(band_.places(), kOutside), depth_(std::move(depth)) {
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      rank_[static_cast<std::size_t>(band_.at(i, j, k))] = rank;
    });
  }

  // Forth and back until nothing changes.  A pass carries depths along all ways that never turn back against
  // the lattice's order; in a solid that bends there may be more of them.
  std::vector<float> run() {
    for (changed_ = true; changed_;) {
      changed_ = false;
      const auto& runs = lattice_.axis[2].runs;
      for (auto run = runs.begin(); run != runs.end(); ++run)
        for (std::uint32_t n = 0; n < run->length; ++n) relax(*run, n, -1);
      for (auto run = runs.rbegin(); run != runs.rend(); ++run)
        for (std::uint32_t n = run->length; n-- > 0;) relax(*run, n, 1);
    }
    return std::move(depth_);
  }

 private:
  static constexpr std::uint32_t kOutside = 0xFFFFFFFFU;

  // Looks at the 13 neighbours on one side: sign -1, those before the point in lattice order.
  void relax(const LatticeRun& run, std::uint32_t n, std::int32_t sign) {
    static const std::array<float, 4> kLength = {0, 1, std::sqrt(2.0F), std::sqrt(3.0F)};
    const auto i = static_cast<std::int32_t>(run.start[0]), j = static_cast<std::int32_t>(run.start[1]),
               k = static_cast<std::int32_t>(run.start[2] + n);
    float least = depth_[run.first + n];
    const float old = least;
    for (std::int32_t a = 0; a <= 1; ++a) {
      for (std::int32_t b = a == 0 ? 0 : -1; b <= 1; ++b) {
        const RowBand::Row& row = band_.row(i + sign * a, j + sign * b);
        for (std::int32_t c = a == 0 && b == 0 ? 1 : -1; c <= 1; ++c) {
          const std::int32_t at = k + sign * c;
          if (at < row.begin || at >= row.end) continue;
          const std::uint32_t rank = rank_[static_cast<std::size_t>(row.offset + at)];
          if (rank == kOutside) continue;
          const std::int32_t steps = a + std::abs(b) + std::abs(c);
          least = std::min(least, depth_[rank] + kLength[static_cast<std::size_t>(steps)]);
        }
      }
    }
    if (least == old) return;
    depth_[run.first + n] = least;
    changed_ = true;
  }

  const Lattice& lattice_;
  RowBand band_;
  std::vector<std::uint32_t> rank_;  // per place of the band
  std::vector<float> depth_;         // per sample point
  bool changed_ = false;
};

}  // namespace

std::vector<float> local_depth(const Lattice& lattice, const FrameField& field) {
  std::vector<float> depths;
  depths.reserve(field.erosion.size());
  for (std::size_t p = 0; p < field.erosion.size(); ++p)
    depths.push_back(static_cast<float>(depth(field.erosion[p], field.gradient[p]) / field.spacing));
  return Relaxation(lattice, std::move(depths)).run();
}

std::vector<float> surface_distance(const Lattice& lattice) {
  std::vector<std::uint8_t> edges(lattice.points, 0);
  for_each_edge(lattice, [&](std::uint32_t low, std::uint32_t high, std::uint8_t, const auto&) {
    ++edges[low];
    ++edges[high];
  });
  std::vector<float> depths(lattice.points);
  for (std::uint32_t p = 0; p < lattice.points; ++p)
    depths[p] = edges[p] < 6 ? 0.5F : std::numeric_limits<float>::max();
  return Relaxation(lattice, std::move(depths)).run();
}

}  // namespace affskel::core
