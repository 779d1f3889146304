#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// A cell that a collapse may not remove, nor its boundary.
struct Anchor {
  DualComplex::Cell cell = 0;  ///< a square, an edge or a vertex
  float weight = 0;            ///< of squares: the lightest one opens the pocket that it bounds
  bool is_end = false;         ///< where a line ends: the ways of others do not lead to it
};

/// All of these and their boundaries.
CellSet closure_of(const DualComplex& complex, std::span<const Anchor> anchors);

/// Of a step to a neighbouring cube, by how many axes it goes along; spacings.
inline constexpr std::array<float, 4> kStepLength{0, 1, std::numbers::sqrt2_v<float>,
                                                  std::numbers::sqrt3_v<float>};

/// No way leads there.
inline constexpr float kNoWay = std::numeric_limits<float>::max();

/// How far every cube lies from the nearest anchor: the cost of the cheapest way over cubes (26 neighbours,
/// see DualComplex::for_each_step) to one about an anchor, to a share of a spacing (Dial 1969).  Ends are where
/// ways come from, and count only where no other anchor can be reached.
/// @param cost per cube, of a spacing there, > 0; empty: 1 everywhere.
/// @return per cube; kNoWay where no anchor can be reached.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<float> shortest_ways(const DualComplex& complex, std::span<const Anchor> anchors,
                                 std::span<const float> cost, ExecutionContext* context = nullptr);

/// Whether such a way of cost 1 everywhere, no longer than `longest` spacings, leads from a cube about a cell to one
/// that is wanted (Dijkstra 1959).  Looks at no more than lies within.
/// @param wanted of a cube, at the end of a way so long.
bool is_near(const DualComplex& complex, DualComplex::Cell from, float longest,
             const std::function<bool(std::uint32_t cube, float way)>& wanted);

}  // namespace affskel::core
