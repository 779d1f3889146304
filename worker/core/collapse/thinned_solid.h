#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/collapsing.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/sheet_fronts.h"

namespace affskel::core {

/// What is left of a solid that is thinned once its cubes and squares have gone, and when they have.  A value: what goes
/// on from here has its own.
struct ThinnedSolid {
  const DualComplex* complex;
  std::span<const float> depth;
  std::span<const double> height;
  CellSet cells;                    ///< lines, with all the hair on them, and closed surfaces
  SheetFronts fronts;               ///< that have passed
  CellValues<float> bared;          ///< per vertex: when a front has left it, spacings
  CellValues<std::uint16_t> freed;  ///< per vertex: see freed_at()
  double slight = 0;                ///< what heights count beside depths

  /// Of those that go at once, and are in each other's way, the lowest goes.  Depths before heights: a line that heights
  /// led would run to where E is great, not along its limb.
  double level(DualComplex::Cell cell) const {
    return value_at<Continued::kFromAllCubes>(*complex, cell, [&](std::uint32_t cube) {
      return static_cast<double>(depth[cube]) + slight * height[cube];
    });
  }

  double radius_at(DualComplex::Cell cell) const { return radius_about(*complex, depth, cell); }

  /// When a vertex lost the last of its edges that went with squares: in times of the collapse, which are told apart by
  /// Collapsing::kStep; what is later than 8191 spacings counts as that.
  double freed_at(DualComplex::Cell vertex) { return freed[vertex] * Collapsing::kStep; }
  void note_freed(DualComplex::Cell vertex, double now) {
    constexpr double kLast = std::numeric_limits<std::uint16_t>::max();
    std::uint16_t& last = freed[vertex];
    last = std::max(last, static_cast<std::uint16_t>(std::min(kLast, now / Collapsing::kStep)));
  }

  /// A square goes, with an edge of its.
  void cross(DualComplex::Cell edge, DualComplex::Cell square, bool passed);
};

/// Collapses a complex from the surface inwards at unit speed, but for lone edges, which go with the vertices at the ends
/// of lines: whether and when they do changes nothing of the rest.
/// A function of its arguments, which must outlive what it returns.
/// @param depth per cube: its distance to the surface, spacings; many are alike.
/// @param height per cube, > 0, such as E: of those that are equally deep, and whose neighbours are, the lowest go first,
///   so that the lattice's order does not decide.
/// @throws CoreError kCancelled when the context asks to stop.
ThinnedSolid thinned_solid(const DualComplex& complex, std::span<const float> depth,
                           std::span<const double> height, ExecutionContext* context = nullptr);

}  // namespace affskel::core
