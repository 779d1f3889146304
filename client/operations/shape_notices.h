#pragma once

#include <string>

#include "client/base/notice.h"
#include "client/base/shape_file.h"
#include "client/files/format.h"

namespace affskel::client {

/// "252 points, 500 triangles" or "5012 points".
std::string counts_text(const ShapeFile& shape);

/// That the output format has no place for the shape's curves, if it has any.
Notices lost_curves(const ShapeFile& shape, FileFormat format, const std::string& output);

/// What of the file the output format cannot hold: columns, by their kind or name, curves, and polygons,
/// which were cut into triangles.
Notices lost_in_format(const ShapeFile& shape, FileFormat format, const std::string& output);

}  // namespace affskel::client
