#pragma once

#include <string>

#include "client/base/shape_file.h"
#include "client/cli/console.h"
#include "client/files/format.h"

namespace affskel::client {

/// "252 points, 500 triangles" or "5012 points".
std::string counts_text(const ShapeFile& shape);

/// Notes what the output will not show of the file: columns for which the format has no place or whose
/// names it cannot hold, polygons that were cut.
void tell_what_is_lost(Console& console, const ShapeFile& shape, FileFormat format,
                       const std::string& output);

}  // namespace affskel::client
