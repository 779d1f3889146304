#pragma once

#include <string>

#include "client/base/shape_file.h"
#include "client/cli/console.h"
#include "client/files/format.h"

namespace affskel::client {

/// "252 points, 500 triangles" or "5012 points".
std::string counts_text(const ShapeFile& shape);

/// Tells that the output format has no place for the shape's curves, if it has any.
void tell_lost_curves(Console& console, const ShapeFile& shape, FileFormat format, const std::string& output);

/// Tells what of the file the output format cannot hold: columns, by their kind or name, curves, and
/// polygons, which were cut into triangles.
void tell_what_is_lost(Console& console, const ShapeFile& shape, FileFormat format,
                       const std::string& output);

}  // namespace affskel::client
