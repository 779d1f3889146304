#pragma once

#include <span>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/base/colour.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

/// Parses a PARTS artefact.
/// @throws ClientError kInternal when numbers are missing or out of range.
v1::SolidParts parse_solid_parts(const std::string& bytes);

/// The solid's surface: its triangles have parts and a thickness.
core::Mesh surface_of(const v1::SolidParts& parts);

/// What the colours of thickness go up to.
struct ThicknessScale {
  double highest = 0;   ///< mesh units, > 0 unless all are 0
  double greatest = 0;  ///< of all: more where that has the last colour, too
};

/// Up to the greatest, unless a hundredth of the surface has a third more than all the rest: where there is no skeleton below
/// a triangle, its thickness tells how far away one is, and few such would leave one colour to all others.
/// @param thickness per triangle of the surface.
ThicknessScale thickness_scale(const core::Mesh& surface, std::span<const double> thickness);

/// Per part, from the first: see part_colours().
std::vector<Rgb> colours_of(const v1::SolidParts& parts);

}  // namespace affskel::client
