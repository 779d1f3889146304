#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/curve/curve_skeleton.h"
#include "core/mesh/mesh.h"
#include "experiments.h"
#include "job.h"
#include "limbed_solids.h"

namespace affskel::experiments {

/// What the comparisons with mean curvature skeletons share.

/// A limb is longer than this share of the longest side.
inline constexpr double kLongLimb = 0.08;

/// The meshes of the setting, or solids of our own.
std::vector<NamedMesh> solids_to_compare(const Setting& setting);

/// The meshes of the setting, or bodies of our own, what is to stay under noise.
std::vector<NamedMesh> bodies_to_compare(const Setting& setting);

/// Of the jobs compared: 100,000 sample points, the mesh's normals, the frame `axis`.  Quick: a twentieth of them.
JobOptions comparison_options(const core::Mesh& mesh, const Setting& setting);

/// The ends of limbs longer than `length`: peaks of the way along the surface from the place of the greatest E.  The
/// crotch, the back and the calves are none, nor is the far side of a ring.
std::vector<core::Vec3> ends_of_limbs(const Job& job, double length);

/// The curve skeleton, in the lattice's frame.
core::CurveSkeleton curve_of(const Job& job, const core::CurveOptions& options = {});

/// Of the vertices of a skeleton in the lattice's frame, mesh units.
std::vector<core::Vec3> places_of(const Job& job, const core::SheetMesh& skeleton);

/// The vertices, and places along the segments no farther apart than `step`.
std::vector<core::Vec3> points_along(std::span<const core::Vec3> places,
                                     std::span<const core::Segment> segments, double step);

/// "98 / 97 %": of the noisy ones within the radius of the clean, and back.
std::string alike(std::span<const core::Vec3> clean, std::span<const core::Vec3> noisy, double radius);

}  // namespace affskel::experiments
