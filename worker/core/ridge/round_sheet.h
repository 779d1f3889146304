#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/contour/sheet_mesh.h"
#include "core/ridge/ridge_constants.h"
#include "core/ridge/ridge_curves.h"

namespace affskel::core {

/// Puts curves in the place of what is found of the sheet where the solid is round: narrow strips and half
/// planes about the curve, turned by chance.
/// 1. A triangle belongs to a stretch when all its corners lie beside it, within its reach and not beyond its
///    ends.  Where triangles about a stretch cross the reach sideways the sheet is wide: it stays, and the
///    stretch is parted; shorter ones than the least length are left out.
/// 2. Triangles that belong to stretches are removed.
/// 3. A stretch is joined to every piece of the sheet that bordered on what was removed, by a segment to the
///    nearest vertex there; once, but for places along it more than two reaches or half its length apart. Its
///    ends are cut back to such joints nearer than a reach.  So pieces stay joined, and no tunnel comes to
///    those there were.
/// 4. Pieces of what is left that lie within the reach of one stretch, and are joined to one place of it or
///    none, are removed.
/// Joints stay in the solid.  Stretches that no triangle belongs to are left out, and those that could be
/// joined at some place from outside alone: there the sheet stays.  A function of mesh, stretches and solid
/// alone.
/// @param mesh without segments; cut (see cut_rims()).
/// @param inside whether a place, frame coordinates, lies in the solid.
/// @return how many stretches were put in.
std::uint32_t put_curves(SheetMesh& mesh, std::span<const RidgeCurve> stretches,
                         const std::function<bool(const Vec3&)>& inside,
                         const RidgeConstants& constants = {});

}  // namespace affskel::core
