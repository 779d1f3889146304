#include "core/chords/chord_edge.h"

#include <algorithm>
#include <cmath>

#include "core/base/unit.h"
#include "core/erosion/edge_value.h"

namespace affskel::core {
namespace {

EdgeValue end_value(const FrameField& field, std::uint32_t point, int axis) {
  return {field.erosion[point], field.gradient[point][axis] * field.spacing};
}

}  // namespace

EdgeCells cells_of(const Lattice& lattice, const SolidParts& parts, std::span<const ChordShock> shocks) {
  std::vector<LatticeEdge> edges;
  edges.reserve(shocks.size());
  for (const ChordShock& shock : shocks) edges.push_back({shock.point, shock.axis, shock.place});
  return edge_cells(lattice, DualComplex(lattice), parts, edges);
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
  shock.position = field.spacing * (vector_of(shock.place) + shock.t * kIdentity3[shock.axis]);
}

}  // namespace affskel::core
