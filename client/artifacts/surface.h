#pragma once

#include <string>

#include "affskel/v1/types.pb.h"
#include "client/base/shape_file.h"

namespace affskel::client {

/// A surface as the server sends it.
struct FetchedSurface {
  ShapeFile shape;              ///< of a sheet with columns
  v1::SkeletonQuality quality;  ///< of a sheet
  double volume = 0;            ///< of an eroded solid
};

/// Parses a SURFACE or ERODED_SURFACE artefact.
/// @throws ClientError kInternal when an index is out of range or a vertex lacks a property.
FetchedSurface parse_surface(const std::string& bytes);

}  // namespace affskel::client
