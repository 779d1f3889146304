#include "core/lattice/lattice.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <span>
#include <string>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/plain_math.h"
#include "core/lattice/lattice_memory.h"
#include "core/lattice/point_spacing.h"
#include "core/lattice/scan_conversion.h"
#include "core/mesh/box.h"

namespace affskel::core {
namespace {

// Tolerance for rounding in v0 / dT^3, so that target_points may equal max_points.
constexpr double kRounding = 1 + 1e-12;

class LatticeBuilder {
 public:
  // Of the options only those that do not say where the points are.
  LatticeBuilder(const Solid& solid, const LatticeGrid& grid, const LatticeOptions& options)
      : mesh_(solid.mesh), options_(options) {
    lattice_.grid = grid;
    const double cell = dot(grid.axes[0], cross(grid.axes[1], grid.axes[2]));
    lattice_.spacing = solid.scale() * cube_root(std::abs(cell));
  }

  std::uint32_t count() {
    if (lattice_.points == 0) fill_axis_2();
    return lattice_.points;
  }

  Lattice run() {
    require_memory(count());
    parallel_for(options_.threads, 2, [this](std::size_t axis) { fill_axis(static_cast<int>(axis)); });
    return std::move(lattice_);
  }

 private:
  // Follows a line through its crossings.  Where the surface crosses itself the line may enter twice before
  // it leaves: `entered` is the crossing at which it came in from outside.
  struct Passage {
    std::int32_t winding = 0;
    std::uint32_t entered = 0;

    void pass(const Crossing& crossing) {
      const bool outside = winding <= 0;
      winding -= crossing.exits;
      if (outside && winding > 0) entered = crossing.triangle;
    }
  };

  // The triangle where a line, inside the solid so far, leaves it at crossing `c` or above.
  static std::uint32_t exit_from(const LineCrossings& lines, std::uint64_t c, std::uint64_t end,
                                 Passage passage) {
    for (std::uint64_t e = c; e < end; ++e) {
      passage.pass(lines.crossings[e]);
      if (passage.winding <= 0) return lines.crossings[e].triangle;
    }
    return lines.crossings[c].triangle;
  }

  void require_memory(double points) const {
    const double lines = static_cast<double>(lattice_.grid.dims[0]) * lattice_.grid.dims[1];
    require_lattice_memory({points, lines, lattice_.spacing}, options_.point_bytes, options_.memory_budget);
  }

  // Axis 2 decides what is inside and numbers the points.
  void fill_axis_2() {
    require_memory(0);
    const LatticeGrid& grid = lattice_.grid;
    const LineCrossings lines = scan_convert(mesh_, grid, 2, options_.threads, options_.context);
    StopCheck stop(options_.context);
    std::uint64_t points = 0;
    for (std::uint32_t i = 0; i < grid.dims[0]; ++i) {
      for (std::uint32_t j = 0; j < grid.dims[1]; ++j) {
        const std::size_t line = std::size_t{i} * grid.dims[1] + j;
        const std::uint64_t last = lines.begin[line + 1];
        Passage passage;
        stop.did(1 + last - lines.begin[line]);
        for (std::uint64_t c = lines.begin[line]; c + 1 < last; ++c) {
          const Crossing &low = lines.crossings[c], &high = lines.crossings[c + 1];
          passage.pass(low);
          if (passage.winding <= 0) continue;
          const std::uint32_t k = clip(low.depth), end = clip(high.depth);
          if (k >= end) continue;
          lattice_.axis[2].runs.push_back({static_cast<std::uint32_t>(points),
                                           end - k,
                                           passage.entered,
                                           exit_from(lines, c + 1, last, passage),
                                           {i, j, k}});
          points += end - k;
          if (points > 0xFFFFFFFEU) {
            throw CoreError(CoreError::Code::kLimit,
                            "the lattice has more than 2^32 points inside the solid");
          }
        }
      }
    }
    lattice_.points = static_cast<std::uint32_t>(points);
  }

  std::uint32_t clip(double depth) const {
    return static_cast<std::uint32_t>(
        std::ceil(std::clamp(depth, 0.0, static_cast<double>(lattice_.grid.dims[2]))));
  }

  struct OnLine {
    std::uint32_t point;
    std::uint32_t along;  // its lattice index along the line
  };

  // Sorts the points into the lines of another axis and cuts these into runs.
  void fill_axis(int axis) {
    const auto a = static_cast<std::size_t>(axis);
    const LineCrossings lines = scan_convert(mesh_, lattice_.grid, axis, 1, options_.context);
    const std::size_t line_count = lines.begin.size() - 1;
    std::vector<std::uint32_t> begin(line_count + 1, 0);
    for_each_point(
        [&](std::uint32_t, const std::array<std::uint32_t, 3>& at) { ++begin[line_of(axis, at) + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> cursor(begin.begin(), begin.end() - 1);
    // Left uninitialised: filling so much memory can take seconds, in which the context is not asked.
    const auto order = std::make_unique_for_overwrite<OnLine[]>(lattice_.points);
    for_each_point([&](std::uint32_t point, const std::array<std::uint32_t, 3>& at) {
      order[cursor[line_of(axis, at)]++] = {point, at[a]};
    });
    std::vector<std::uint32_t>& kept = lattice_.axis[a].order;
    kept.reserve(lattice_.points);
    StopCheck stop(options_.context);
    for (std::size_t line = 0; line < line_count; ++line) {
      stop.did(1 + begin[line + 1] - begin[line]);
      cut_line(a, lines, line, {order.get() + begin[line], order.get() + begin[line + 1]});
    }
  }

  // Lines are numbered as in LineCrossings.
  std::size_t line_of(int axis, const std::array<std::uint32_t, 3>& at) const {
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    return std::size_t{at[u]} * lattice_.grid.dims[v] + at[v];
  }

  template <class Visit>
  void for_each_point(Visit visit) const {
    StopCheck stop(options_.context);
    for (const LatticeRun& run : lattice_.axis[2].runs) {
      stop.did(run.length);
      std::array<std::uint32_t, 3> at = run.start;
      for (std::uint32_t p = run.first; p < run.first + run.length; ++p, ++at[2]) visit(p, at);
    }
  }

  // Points come in lattice order, so each line's are ascending along the axis.
  void cut_line(std::size_t a, const LineCrossings& lines, std::size_t line, std::span<const OnLine> points) {
    std::uint64_t next = lines.begin[line];
    const std::uint64_t end = lines.begin[line + 1];
    const std::size_t u = (a + 1) % 3, v = (a + 2) % 3, width = lattice_.grid.dims[v];
    std::array<std::uint32_t, 3> at{};
    at[u] = static_cast<std::uint32_t>(line / width);
    at[v] = static_cast<std::uint32_t>(line % width);
    AxisRuns& axis = lattice_.axis[a];
    Passage passage;
    LatticeRun* open = nullptr;
    for (const OnLine& on_line : points) {
      at[a] = on_line.along;
      for (; next < end && lines.crossings[next].depth <= at[a]; ++next) {
        passage.pass(lines.crossings[next]);
        open = nullptr;
      }
      if (passage.winding <= 0 || next == end) {
        const LatticeRun& column = column_of(on_line.point);
        axis.strays.push_back({on_line.point, 1, column.low, column.high, at});
        open = nullptr;
        continue;
      }
      if (open == nullptr) {
        axis.runs.push_back({static_cast<std::uint32_t>(axis.order.size()), 0, passage.entered,
                             exit_from(lines, next, end, passage), at});
        open = &axis.runs.back();
      }
      ++open->length;
      axis.order.push_back(on_line.point);
    }
  }

  // The run along axis 2 that has the point.
  const LatticeRun& column_of(std::uint32_t point) const {
    return *std::prev(std::ranges::upper_bound(lattice_.axis[2].runs, point, {}, &LatticeRun::first));
  }

  const Mesh& mesh_;
  LatticeOptions options_;
  Lattice lattice_;
};

double wanted_spacing(const Solid& solid, const LatticeOptions& options) {
  if (options.spacing == 0 && options.target_points > 0) {
    return cube_root(solid.volume / static_cast<double>(options.target_points));
  }
  if (!(options.spacing > 0) || !std::isfinite(options.spacing)) {
    refuse("the spacing must be a finite number > 0, not " + base::to_text(options.spacing));
  }
  return options.spacing;
}

// The solid's bounding box in a frame's coordinates.
struct FrameBox {
  Vec3 sides;   // mesh units
  Vec3 centre;  // scaled coordinates
};

FrameBox box_in(const Solid& solid, const Matrix3& f) {
  if (f == kIdentity3) return {solid.bbox_max - solid.bbox_min, {}};
  const Box box = box_of(solid.mesh.points, inverse_transposed(f));
  return {solid.scale() * box.sides(), f * box.middle()};
}

// The lattice of a spacing before its points are found.
struct Plan {
  LatticeGrid grid;
  double lines = 0;
  double estimate = 0;  // of the points
  bool fits = false;    // within the limits; only then is there a grid
};

// An even number, or one: so the middle planes of the box, where mirror-symmetric solids have their
// skeletons, lie half-way between sample points.  At a point in the skeleton two chords are equal, and
// rounding would choose between them.  No point lies on the box itself, nor within rounding of it.
double points_per_side(double steps) {
  constexpr double kShrunk = 1 - 1e-9;
  return steps * kShrunk > 1 ? 2 * std::ceil((steps * kShrunk - 1) / 2) : 1;
}

Plan plan_lattice(const Solid& solid, const FrameBox& box, const LatticeOptions& options, double spacing) {
  const Vec3& sides = box.sides;
  Plan plan;
  plan.lines = (sides.x / spacing + 1) * (sides.y / spacing + 1) +
               (sides.y / spacing + 1) * (sides.z / spacing + 1) +
               (sides.z / spacing + 1) * (sides.x / spacing + 1);
  plan.estimate = solid.volume / spacing / spacing / spacing;
  plan.fits = plan.estimate <= kRounding * static_cast<double>(options.max_points) &&
              plan.lines <= static_cast<double>(options.max_lines);
  if (!plan.fits) return plan;
  const double step = std::ldexp(spacing, -solid.exponent);
  plan.grid.axes = step * options.frame;
  Vec3 corner;
  for (std::size_t k = 0; k < 3; ++k) {
    const double count = points_per_side(sides[k] / spacing);
    plan.grid.dims[k] = static_cast<std::uint32_t>(count);
    corner[k] = -0.5 * (count - 1) * step;
  }
  plan.grid.origin = box.centre + options.frame * corner;
  return plan;
}

// The least spacing within the limits: (v0 / max_points)^(1/3), or the one that has max_lines lines.
double least_spacing(const Solid& solid, const FrameBox& box, const LatticeOptions& options) {
  const double by_points = cube_root(solid.volume / static_cast<double>(options.max_points));
  const double longest = largest_component(box.sides);
  const Vec3 s = (1 / longest) * box.sides;
  const double sum = s.x + s.y + s.z, area = s.x * s.y + s.y * s.z + s.z * s.x;
  const double lines = static_cast<double>(options.max_lines) - 3;
  return std::max(by_points, longest * (sum + std::sqrt(sum * sum + area * lines)) / lines);
}

// A count for messages, "about 1200", of any size.
std::string about(double number) {
  return std::isfinite(number) ? "about " + base::rounded(number, 3) : "more than 1e+308";
}

// The plan of a lattice that must lie within the limits.
Plan fitting_plan(const Solid& solid, const FrameBox& box, const LatticeOptions& options, double spacing) {
  const Plan plan = plan_lattice(solid, box, options, spacing);
  if (plan.fits) return plan;
  // Rounded up.
  const std::string least = base::rounded(1.00051 * least_spacing(solid, box, options), 4);
  throw CoreError(CoreError::Code::kLimit,
                  "spacing " + base::rounded(spacing, 3) + " would give " + about(plan.estimate) +
                      " sample points on " + about(plan.lines) + " lattice lines; at most " +
                      base::rounded(static_cast<double>(options.max_points), 3) + " points on " +
                      base::rounded(static_cast<double>(options.max_lines), 3) +
                      " lines are supported: take a spacing of " + least + " or more");
}

// Whether to search for a lattice of so many points although it does not fit: yes if only the lines are too
// many, since a thin solid may not need them.
bool may_search(const Plan& plan, const LatticeOptions& options) {
  return options.spacing == 0 && plan.estimate <= kRounding * static_cast<double>(options.max_points);
}

Lattice lattice_at(const Solid& solid, const FrameBox& box, const LatticeOptions& options, double spacing) {
  const Plan plan = fitting_plan(solid, box, options, spacing);
  Lattice lattice = LatticeBuilder(solid, plan.grid, options).run();
  lattice.spacing = spacing;
  if (lattice.points == 0) {
    refuse("no lattice point falls inside the solid: spacing " + base::rounded(spacing, 3) +
           " is too coarse for a volume of " + base::rounded(solid.volume, 3));
  }
  return lattice;
}

}  // namespace

Lattice make_lattice(const Solid& solid, const LatticeGrid& grid, unsigned threads) {
  for (std::uint32_t n : grid.dims) {
    if (n == 0 || n > (1U << 30)) refuse("a side of the lattice has no or too many points");
  }
  return LatticeBuilder(solid, grid, {.threads = threads}).run();
}

std::optional<std::uint32_t> lattice_points(const Solid& solid, const LatticeOptions& options) {
  const Plan plan = plan_lattice(solid, box_in(solid, options.frame), options, options.spacing);
  if (!plan.fits) return std::nullopt;
  return LatticeBuilder(solid, plan.grid, options).count();
}

void check_lattice(const Solid& solid, FrameKind kind, LatticeOptions options) {
  const double spacing = wanted_spacing(solid, options);
  // In no orientation is a side of the box longer than this.  Tried first, because some frames take minutes.
  const double diagonal = kRounding * norm(solid.bbox_max - solid.bbox_min);
  const Plan largest = plan_lattice(solid, {{diagonal, diagonal, diagonal}, {}}, options, spacing);
  if (may_search(largest, options) || (largest.fits && kind != FrameKind::kAffine)) return;
  options.frame = solid_frame(solid, kind);
  fitting_plan(solid, box_in(solid, options.frame), options, spacing);
}

Lattice make_lattice(const Solid& solid, const LatticeOptions& options) {
  const double spacing = wanted_spacing(solid, options);
  const FrameBox box = box_in(solid, options.frame);
  const Plan plan = plan_lattice(solid, box, options, spacing);
  if (may_search(plan, options)) {
    if (plan.fits && !is_foil(solid, spacing)) {
      LatticeBuilder builder(solid, plan.grid, options);
      if (is_near(builder.count(), options.target_points)) {
        Lattice lattice = builder.run();
        lattice.spacing = spacing;
        return lattice;
      }
    }
    return lattice_at(solid, box, options, spacing_for_points(solid, options, spacing));
  }
  return lattice_at(solid, box, options, spacing);
}

}  // namespace affskel::core
