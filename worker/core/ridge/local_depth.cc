#include "core/ridge/local_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/base/unit.h"
#include "core/collapse/shortest_ways.h"
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
      : lattice_(lattice), band_(lattice, 0), rank_(ranks_in(band_, lattice)), depth_(std::move(depth)) {}

  // Forth and back until nothing changes.  A pass carries depths along all ways that never turn back against
  // the lattice's order; in a solid that bends there may be more of them.
  std::vector<float> run() {
    for (changed_ = true; changed_;) {
      changed_ = false;
      const auto& runs = lattice_.axis[2].runs;
      for (auto run = runs.begin(); run != runs.end(); ++run) {
        const Rows rows = rows_beside(*run, -1);
        for (std::uint32_t n = 0; n < run->length; ++n) relax(*run, rows, n, -1);
      }
      for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
        const Rows rows = rows_beside(*run, 1);
        for (std::uint32_t n = run->length; n-- > 0;) relax(*run, rows, n, 1);
      }
    }
    return std::move(depth_);
  }

 private:
  struct RowBeside {
    const RowBand::Row* row = nullptr;
    std::int32_t steps = 0;
  };
  using Rows = std::array<RowBeside, 5>;

  // A run's own row and the four on one side: sign -1, those before it in lattice order.
  Rows rows_beside(const LatticeRun& run, std::int32_t sign) const {
    const auto i = static_cast<std::int32_t>(run.start[0]), j = static_cast<std::int32_t>(run.start[1]);
    const auto at = [&](std::int32_t a, std::int32_t b) {
      return RowBeside{&band_.row(i + sign * a, j + sign * b), a + std::abs(b)};
    };
    return {at(0, 0), at(0, 1), at(1, -1), at(1, 0), at(1, 1)};
  }

  // Looks at the 13 neighbours on one side.
  void relax(const LatticeRun& run, const Rows& rows, std::uint32_t n, std::int32_t sign) {
    const auto k = static_cast<std::int32_t>(run.start[2] + n);
    float least = depth_[run.first + n];
    const float old = least;
    for (const auto& [row, steps] : rows) {
      for (std::int32_t c = steps == 0 ? 1 : -1; c <= 1; ++c) {
        const std::int32_t at = k + sign * c;
        if (at < row->begin || at >= row->end) continue;
        const std::uint32_t rank = rank_[static_cast<std::size_t>(row->offset + at)];
        if (rank == kNone) continue;
        least = std::min(least, depth_[rank] + kStepLength[static_cast<std::size_t>(steps + std::abs(c))]);
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
