#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/vec3.h"
#include "core/chords/chord_shocks.h"
#include "core/contour/edge_cells.h"
#include "core/erosion/frame_field.h"

namespace affskel::core {

/// The cells round the edges of the shocks, in their order.
EdgeCells cells_of(const Lattice& lattice, const SolidParts& parts, std::span<const ChordShock> shocks);

/// The order of lists of shocks: by (point, axis).
inline bool by_edge(const ChordShock& a, const ChordShock& b) {
  return a.point != b.point ? a.point < b.point : a.axis < b.axis;
}

/// The shock that the tangents of E at the ends of a lattice edge describe, not judged: where there is none,
/// r is negative and t anywhere (or not finite).  `position` and `erosion` are 0; see clamp_to_edge().
/// @param x, y ranks of the edge's lower and upper end, both with an optimal direction.
/// @param place lattice indices of x.
ChordShock tangents_on_edge(const FrameField& field, std::uint32_t x, std::uint32_t y, std::uint8_t axis,
                            const std::array<std::uint32_t, 3>& place);

/// Clamps t to [0, 1], or sets it to 1/2 when the tangents do not cross, and sets `position` and `erosion`.
void clamp_to_edge(const FrameField& field, ChordShock& shock);

/// The opening o = (1 - a.b / (|a| |b|)) / 2 of two normals of any length, 0 .. 1; NaN when one is zero.
double opening_of(const Vec3& a, const Vec3& b);

}  // namespace affskel::core
