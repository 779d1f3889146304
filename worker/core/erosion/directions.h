#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/direction_set.h"
#include "core/base/matrix3.h"
#include "core/base/vec3.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Directions d of the planes, unit vectors; the chord lies on the side d.y <= d.x.  An entry
/// (0, 0, 0) stands for a triangle without area and is never an optimum.
using DirectionSet = std::vector<Vec3>;

/// Optimal direction per sample point: indices into a direction set, FieldValue::kNoDirection = none yet.
using OptimalDirections = std::vector<std::uint32_t>;

struct DirectionOptions {
  std::uint64_t max_directions = base::kMaxDirections;  ///< refuse larger sets; sphere:N counts as N
  Matrix3 frame = kIdentity3;                           ///< F of sphere and random, see solid_frame
};

/// The set that `spec` names: one of these, or several joined by "+" in their order.
///   triangles      the inward unit normals of the solid's triangles, by triangle;
///   sphere:N       the inward normals of the geodesic sphere of 20 f^2 triangles (the icosahedron's faces
///                  cut f-fold), f least with 20 f^2 >= N;
///   random:N:SEED  N uniform unit vectors (rejection from the cube, SplitMix64 from SEED).
/// Those of sphere and random are normals n_u in the frame's coordinates: in the mesh's F^-T n_u, normalised.
/// So they go along with a map of solid and frame, as the triangles' normals do by themselves.
/// Only +, -, *, / and sqrt are used, so that all machines agree on every bit.
/// @throws CoreError kBadInput for a spec that does not parse; kLimit for too many directions.
DirectionSet make_directions(const Solid& solid, std::string_view spec, const DirectionOptions& options = {});

/// Throws at once what make_directions would throw.
void check_directions(const Solid& solid, std::string_view spec, const DirectionOptions& options = {});

}  // namespace affskel::core
