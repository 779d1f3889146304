#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"
#include "core/curve/limb_surface.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// The vertex that a place belongs to, by the vertex of the lines that it belonged to.
using VertexOfPlace = std::function<std::uint32_t(const Vec3& at, std::uint32_t nearest)>;

/// Gives each sample point another vertex, on up to `threads` threads.
/// @param vertex_of called from several at once.
/// @param nearest per sample point: the vertex that it has.
/// @return per vertex: the share of all points that it has then.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<double> given_anew(const Lattice& lattice, const VertexOfPlace& vertex_of, std::size_t vertices,
                               std::span<std::uint32_t> nearest, unsigned threads, ExecutionContext* context);

/// Lines, and how thick the solid is along them.
struct SlicedLines {
  std::vector<Vec3> places;                       ///< per vertex
  std::vector<double> balls;                      ///< per vertex: see LimbSurface::thickness()
  std::vector<double> slices;                     ///< per vertex: share of all sample points
  std::vector<double> radius;                     ///< per vertex: see slice_radii()
  std::vector<std::vector<std::uint32_t>> lines;  ///< see polylines()
};

struct SlicedLinesInput {
  const Solid& solid;
  const Lattice& lattice;      ///< of the solid
  const LimbSurface& surface;  ///< of it, in the coordinates of the lines
  const SheetMesh& curve;      ///< lines, and no triangles
  unsigned threads = 1;        ///< the result does not depend on it
  ExecutionContext* context = nullptr;
};

/// Cuts a solid into slices: a point goes from the vertex that it has on along the line to the one that is nearest to it, as
/// far as that comes nearer.
/// @param nearest per sample point: its vertex; becomes that.
/// @throws CoreError kCancelled when the context asks to stop.
SlicedLines sliced_lines(const SlicedLinesInput& input, std::span<std::uint32_t> nearest);

}  // namespace affskel::core
