#pragma once

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

/// Per part, from the first: see part_colours().
std::vector<Rgb> colours_of(const v1::SolidParts& parts);

}  // namespace affskel::client
