#include "core/chords/chord_edge.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/scaled_to_unit.h"
#include "core/erosion/edge_value.h"

namespace affskel::core {
namespace {

EdgeValue end_value(const FrameField& field, std::uint32_t point, int axis) {
  return {field.erosion[point], field.gradient[point][axis] * field.spacing};
}

}  // namespace

std::optional<std::array<std::uint32_t, 2>> ends_of_edge(const Lattice& lattice, std::uint8_t axis,
                                                         const std::array<std::uint32_t, 3>& place) {
  const AxisRuns& along = lattice.axis[axis];
  // The order of the runs: line by line, and along each.
  const auto key = [u = (axis + 1U) % 3, v = (axis + 2U) % 3, axis](const std::array<std::uint32_t, 3>& at) {
    return std::array{at[u], at[v], at[axis]};
  };
  const auto next =
      std::upper_bound(along.runs.begin(), along.runs.end(), place,
                       [&](const auto& at, const LatticeRun& run) { return key(at) < key(run.start); });
  if (next == along.runs.begin()) return {};
  const LatticeRun& run = *std::prev(next);
  const auto [u, v, w] = key(place);
  const auto [run_u, run_v, run_w] = key(run.start);
  if (u != run_u || v != run_v || w - run_w >= run.length) return {};
  const std::uint32_t n = run.first + (w - run_w);
  const bool last = n + 1 == run.first + run.length;
  if (last && (next == along.runs.end() || !continues_in(run, *next, axis))) return {};
  if (along.order.empty()) return std::array{n, n + 1};
  return std::array{along.order[n], along.order[n + 1]};
}

double opening_of(const Vec3& a, const Vec3& b) {
  const Vec3 m = scaled_to_unit(a), n = scaled_to_unit(b);
  return 0.5 * (1 - dot(m, n) / (norm(m) * norm(n)));
}

ChordShock tangents_on_edge(const FrameField& field, std::uint32_t x, std::uint32_t y, std::uint8_t axis,
                            const std::array<std::uint32_t, 3>& place) {
  const EdgeValue at_x = end_value(field, x, axis), at_y = end_value(field, y, axis);
  ChordShock shock;
  shock.point = x;
  shock.upper = y;
  shock.axis = axis;
  shock.place = place;
  shock.t = tangents_crossing(at_x, at_y);
  shock.strength = tangents_kink(at_x, at_y) / (std::abs(at_x.slope) + std::abs(at_y.slope));
  shock.opening = opening_of(field.gradient[x], field.gradient[y]);
  shock.gradient_low = field.gradient[x];
  shock.gradient_high = field.gradient[y];
  shock.direction_low = field.direction[x];
  shock.direction_high = field.direction[y];
  return shock;
}

void clamp_to_edge(const FrameField& field, ChordShock& shock) {
  const EdgeValue at_x = end_value(field, shock.point, shock.axis);
  shock.t = shock.strength > 0 ? std::clamp(shock.t, 0.0, 1.0) : 0.5;
  shock.erosion = shock.t < 1 ? at_x.erosion + shock.t * at_x.slope : field.erosion[shock.upper];
  std::array<double, 3> u{};
  for (std::size_t k = 0; k < 3; ++k) u[k] = shock.place[k];
  u[shock.axis] += shock.t;
  shock.position = field.spacing * Vec3{u[0], u[1], u[2]};
}

}  // namespace affskel::core
