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
      : lattice_(lattice),
        band_(lattice, 0),
        rank_(ranks_in(band_, lattice)),
        depth_(std::move(depth)),
        changed_(band_.places() / kBlock + 1, 1) {}

  // Forth and back until nothing changes.  A pass carries depths along all ways that never turn back against
  // the lattice's order; in a solid that bends there may be many of them, which look only beside what changed in the pass
  // before or in theirs.
  std::vector<float> run(ExecutionContext* context) {
    StopCheck stop(context);
    const auto& runs = lattice_.axis[2].runs;
    for (pass_ = 1; pass_ <= last_ + 1; ++pass_) {
      const auto relax_run = [&](const LatticeRun& run) {
        const std::int32_t sign = pass_ % 2 == 1 ? -1 : 1;
        const Rows rows = rows_beside(run, sign);
        if (!may_change(run, rows)) return;
        stop.did(10 * std::uint64_t{run.length});
        for (std::uint32_t n = 0; n < run.length; ++n)
          relax(run, rows, sign < 0 ? n : run.length - 1 - n, sign);
      };
      if (pass_ % 2 == 1)
        std::for_each(runs.begin(), runs.end(), relax_run);
      else
        std::for_each(runs.rbegin(), runs.rend(), relax_run);
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

  static std::size_t block(const RowBeside& row, std::int32_t k) {
    return static_cast<std::size_t>(row.row->offset + k) / kBlock;
  }

  // Whether anything beside a run has changed since it was looked at.
  bool may_change(const LatticeRun& run, const Rows& rows) const {
    const auto start = static_cast<std::int32_t>(run.start[2]);
    for (const RowBeside& row : rows) {
      const std::int32_t first = std::max(row.row->begin, start - 1);
      const std::int32_t last = std::min(row.row->end, start + static_cast<std::int32_t>(run.length) + 1) - 1;
      if (first > last) continue;
      for (std::size_t at = block(row, first); at <= block(row, last); ++at)
        if (changed_[at] + 1 >= pass_) return true;
    }
    return false;
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
    changed_[block(rows[0], k)] = last_ = pass_;
  }

  static constexpr std::size_t kBlock = 32;

  const Lattice& lattice_;
  RowBand band_;
  std::vector<std::uint32_t> rank_;     // per place of the band
  std::vector<float> depth_;            // per sample point
  std::vector<std::uint32_t> changed_;  // per so many places of the band: the last pass that changed one
  std::uint32_t pass_ = 0, last_ = 1;   // passes from 1 on, and the last that changed any
};

}  // namespace

std::vector<float> local_depth(const Lattice& lattice, const FrameField& field, ExecutionContext* context) {
  std::vector<float> depths;
  depths.reserve(field.erosion.size());
  for (std::size_t p = 0; p < field.erosion.size(); ++p)
    depths.push_back(static_cast<float>(depth(field.erosion[p], field.gradient[p]) / field.spacing));
  return Relaxation(lattice, std::move(depths)).run(context);
}

std::vector<float> surface_distance(const Lattice& lattice, ExecutionContext* context) {
  std::vector<std::uint8_t> edges(lattice.points, 0);
  for_each_edge(lattice, [&](std::uint32_t low, std::uint32_t high, std::uint8_t, const auto&) {
    ++edges[low];
    ++edges[high];
  });
  std::vector<float> depths(lattice.points);
  for (std::uint32_t p = 0; p < lattice.points; ++p)
    depths[p] = edges[p] < 6 ? 0.5F : std::numeric_limits<float>::max();
  return Relaxation(lattice, std::move(depths)).run(context);
}

}  // namespace affskel::core
