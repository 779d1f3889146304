#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/chords/chord_pruning.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/quality/advice.h"
#include "core/shocks/shock_operator.h"
#include "core/solid/betti_numbers.h"

namespace affskel::core {

/// Why a thresholded skeleton is empty and what to try: the largest |H|
/// there is and a threshold that would keep about as many points as a sheet through the lattice has; that
/// there are few distinct optimal normals (a box has six); that there are few sample points.
/// @param divergence H per sample point, none with |H| > threshold.
/// @param more_directions of the job's set than the mesh has triangles: what was done is not advised.
Advice empty_skeleton_advice(const Lattice& lattice, const OptimalDirections& optimal,
                             const std::vector<double>& divergence, ShockOperator shock_operator,
                             double threshold, std::size_t more_directions = 0);

/// The same for the operator `chords`.  One of these:
/// - there are no two equal chords at all;
/// - none of clearly different directions; then it names the widest angle there is and, when the frame
///   stretches, other frames (`affine` makes a flat solid as thick as it is wide, so that its chords no
///   longer oppose each other);
/// - strong shocks only where E is small;
/// - only pieces below the significance; then it names one that keeps the heaviest.
/// @param census of a sheet without shocks.
/// @param significance that it was made with. @param strong_turn that was applied.
/// @param more_directions see empty_skeleton_advice().
Advice empty_sheet_advice(const Lattice& lattice, const ShockCensus& census, double significance,
                          double strong_turn, std::size_t more_directions = 0);

/// The same for a sheet of either that a least barrier has emptied: names the greatest one that keeps a
/// triangle or a segment.
/// @param triangles, segments of the sheet before. @param barrier per vertex of these. @param least that was
///   asked for.
Advice low_barriers_advice(std::span<const Triangle> triangles, std::span<const Segment> segments,
                           std::span<const double> barrier, double least);

/// That a skeleton of the lattice is not the solid's, where their pieces, tunnels or voids differ, and how many sample
/// points to try; else nothing.
/// @param of_lattice of the complex of its sample points, but for what is left out. @param surfaces_meet so that the
///   solid's numbers count apart what is one: no number of points helps.
Advice coarse_lattice_advice(const Lattice& lattice, const BettiNumbers& of_lattice,
                             const BettiNumbers& solid, bool surfaces_meet = false);

/// That the lattice has nowhere more than two points across the solid, or that the skeleton is hardly more than a point,
/// and how many points to try where they may be too few; else nothing.
/// @param radius per sample point: see surface_distance(). @param vertices of the skeleton, of a piece in the mean.
Advice small_skeleton_advice(const Lattice& lattice, std::span<const float> radius, std::size_t vertices);

/// That much of the solid has no skeleton near it, for as thick as it is there; else nothing.  In a wall that is bent, as
/// of a bowl or a mug, E grows up to the hollow side, cut from the other one: it has no ridge.
/// @param radius per sample point: see surface_distance(). @param places of the skeleton's vertices, in the frame.
/// @param points the sample point of each.
Advice bare_solid_advice(const Lattice& lattice, std::span<const float> radius, std::span<const Vec3> places,
                         std::span<const std::uint32_t> points);

/// That the lines of `curve` leave out much of the solid, because it is flat; else nothing.
/// @param radius, places, points as for bare_solid_advice(), of the lines.
Advice flat_solid_advice(const Lattice& lattice, std::span<const float> radius, std::span<const Vec3> places,
                         std::span<const std::uint32_t> points);

/// That hardly any of a skeleton of `ridge` is ridge, so that nearly all of it are ways and membranes, which join what
/// is found or keep the solid's topology; else nothing.
/// @param share of its vertices that lie on ridges.
/// @param threshold of these: a third of it is suggested, or of the strongest ridge that there is.
/// @param strongest this one's strength, see RidgeSheet; nothing is suggested for 0.
Advice little_ridge_advice(double share, double threshold, double strongest);

/// That limbs of `curve` are told in a frame that stretches the solid, so that some may not be, and the frame in which
/// they are told as they are; nothing where it hardly does.
Advice stretched_limbs_advice(const Lattice& lattice);

/// What is wrong with a sheet of `chords`: that it is not the solid's, where their pieces, tunnels or voids differ, or that
/// there is hardly any, or none near much of the solid; else nothing.
/// @param places of its shocks, in the frame. @param points the sample point of each.
Advice stray_sheet_advice(const Lattice& lattice, std::span<const float> radius, std::span<const Vec3> places,
                          std::span<const std::uint32_t> points, const BettiNumbers& sheet,
                          const BettiNumbers& solid);

}  // namespace affskel::core
