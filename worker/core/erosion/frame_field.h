#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/matrix3.h"
#include "core/erosion/directions.h"
#include "core/erosion/field.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

// The coordinates u of a lattice's frame: x = o + F u, det F = 1 (or -1), F's columns the lattice's axes
// divided by the spacing.  README.md in worker/core tells how planes and gradients go over.

/// F, column by column; exactly the identity for a lattice parallel to the axes.
Matrix3 frame_matrix(const Lattice& lattice);

/// The directions as unit normals in the frame: F^T d / |F^T d|; those of zero length stay so.  Exactly the
/// given ones when F is the identity.
DirectionSet frame_directions(const Lattice& lattice, const DirectionSet& directions);

/// A finished erosion field in the frame of its lattice: what shock operators and level surfaces work on.
struct FrameField {
  double spacing = 0;                    ///< of the lattice
  std::vector<double> erosion;           ///< per sample point: E, volume
  std::vector<Vec3> gradient;            ///< per sample point: grad_u E = A F^T n, exact (envelope theorem)
  std::vector<std::uint32_t> direction;  ///< per sample point: index of the optimal direction
};

/// The area |grad_x E| = |F^-T g| of an optimal section, mesh units squared.
/// @param to_mesh F^-T of the frame.
/// @param gradient g = grad_u E, of any size.
double section_area(const Matrix3& to_mesh, const Vec3& gradient);

/// Per sample point the radius of a disc as large as the optimal section in the frame, spacings: how thick a limb is
/// there, whatever noise has made of its surface.
std::vector<float> section_radii(const FrameField& field);

/// @param values E (mesh units cubed), area (mesh units squared) and direction per sample point; a point
///   without a direction gets E = +infinity and gradient 0.
FrameField frame_field(const Lattice& lattice, const DirectionSet& directions,
                       std::span<const FieldValue> values);

}  // namespace affskel::core
