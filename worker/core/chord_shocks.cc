#include "core/chord_shocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/edge_value.h"
#include "core/error.h"
#include "core/field.h"

namespace affskel::core {
namespace {

void check(double value, double low, double high, const char* message) {
  if (!(value >= low && value <= high)) throw CoreError(CoreError::Code::kBadInput, message);
}

class ShockFinder {
 public:
  ShockFinder(const Lattice& lattice, const FrameField& field, const ChordShockOptions& options)
      : lattice_(lattice), field_(field), options_(options) {}

  std::vector<ChordShock> run() {
    for (int axis = 0; axis < 3; ++axis) walk(axis);
    std::sort(shocks_.begin(), shocks_.end(), [](const ChordShock& a, const ChordShock& b) {
      return a.point != b.point ? a.point < b.point : a.axis < b.axis;
    });
    return std::move(shocks_);
  }

 private:
  // Only neighbours of one run: between two runs lies the surface, and across it E says nothing.
  void walk(int axis) {
    const AxisRuns& along = lattice_.axis[static_cast<std::size_t>(axis)];
    for (const LatticeRun& run : along.runs) {
      for (std::uint32_t n = 0; n + 1 < run.length; ++n) {
        const std::uint32_t at = run.first + n;
        const std::uint32_t x = along.order.empty() ? at : along.order[at];
        const std::uint32_t y = along.order.empty() ? at + 1 : along.order[at + 1];
        if (std::optional<ChordShock> shock = between(x, y, axis)) {
          shock->place = run.start;
          shock->place[static_cast<std::size_t>(axis)] += n;
          shock->position = position(*shock);
          shocks_.push_back(*shock);
        }
      }
    }
  }

  std::optional<ChordShock> between(std::uint32_t x, std::uint32_t y, int axis) const {
    const std::uint32_t none = FieldValue::kNoDirection;
    if (field_.direction[x] == field_.direction[y] || field_.direction[x] == none ||
        field_.direction[y] == none) {
      return {};
    }
    const Vec3 &g_x = field_.gradient[x], &g_y = field_.gradient[y];
    const EdgeValue at_x{field_.erosion[x], g_x[axis] * field_.spacing};
    const EdgeValue at_y{field_.erosion[y], g_y[axis] * field_.spacing};
    const double kink = tangents_kink(at_x, at_y);
    if (!(kink > 0)) return {};
    ChordShock shock;
    shock.strength = kink / (std::abs(at_x.slope) + std::abs(at_y.slope));
    shock.opening = 0.5 * (1 - dot(g_x, g_y) / (norm(g_x) * norm(g_y)));
    shock.t = tangents_crossing(at_x, at_y);
    if (!(shock.strength >= options_.least_strength && shock.opening >= options_.least_opening)) return {};
    if (!(shock.t >= -options_.slack && shock.t <= 1 + options_.slack)) return {};
    shock.t = std::clamp(shock.t, 0.0, 1.0);
    shock.point = x;
    shock.upper = y;
    shock.axis = static_cast<std::uint8_t>(axis);
    shock.erosion = shock.t < 1 ? at_x.erosion + shock.t * at_x.slope : at_y.erosion;
    shock.gradient_low = g_x;
    shock.gradient_high = g_y;
    shock.direction_low = field_.direction[x];
    shock.direction_high = field_.direction[y];
    return shock;
  }

  Vec3 position(const ChordShock& shock) const {
    std::array<double, 3> u{};
    for (std::size_t k = 0; k < 3; ++k) u[k] = shock.place[k];
    u[shock.axis] += shock.t;
    return field_.spacing * Vec3{u[0], u[1], u[2]};
  }

  const Lattice& lattice_;
  const FrameField& field_;
  const ChordShockOptions& options_;
  std::vector<ChordShock> shocks_;
};

}  // namespace

std::vector<ChordShock> chord_shocks(const Lattice& lattice, const FrameField& field,
                                     const ChordShockOptions& options) {
  check(options.least_strength, 0, 1, "the least strength of a shock must lie between 0 and 1");
  check(options.least_opening, 0, 1, "the least opening of a shock must lie between 0 and 1");
  check(options.slack, 0, std::numeric_limits<double>::max(),
        "the slack of a crossing must be a finite number >= 0");
  return ShockFinder(lattice, field, options).run();
}

}  // namespace affskel::core
