#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/ridge/ridge_constants.h"
#include "core/ridge/ridge_rims.h"
#include "core/ridge/smoothed_derivatives.h"
#include "core/solid/solid.h"

namespace affskel::core {

struct RidgeSheetOptions {
  RidgeBounds bounds;
  /// What smoothed_derivatives() gave for this field, for several sheets of one field; empty: they are
  /// computed.
  std::span<const PointDerivatives> known_derivatives;
  ExecutionContext* context = nullptr;  ///< asked whether to stop, between the steps and layers
};

/// The ridge surface of the E field.
struct RidgeSheet : SheetMesh {
  RidgePieces pieces;
  std::uint32_t flaps_cut = 0;     ///< see cut_flaps()
  std::uint32_t holes_closed = 0;  ///< see close_holes()
  std::uint32_t curves = 0;        ///< see put_curves()
};

/// The skeleton as a ridge: the surface where E is greatest across the direction in which it bends most, a
/// height ridge of codimension 1 (Haralick 1983; Eberly 1996; as a crease surface Schultz, Theisel and Seidel
/// 2010), where the normals of the level surfaces turn fast.  Every shock is one, with a strength that grows
/// without bound as the lattice becomes finer; so is the middle sheet of a smooth body, which is no shock.
/// README.md in worker/core tells how and why.
///
/// Each part of the solid (see SolidParts) has the sheet that it would have alone.  A function of solid,
/// lattice and field alone.
/// @param lattice of this solid.
/// @param field of this lattice.
/// @throws CoreError kBadInput when a bound is not finite or out of range, or there are not as many known
///   derivatives as points; kLimit for 2^30 crossings and more; kCancelled when the context asks to stop.
RidgeSheet ridge_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const RidgeSheetOptions& options = {}, const RidgeConstants& constants = {});

}  // namespace affskel::core
