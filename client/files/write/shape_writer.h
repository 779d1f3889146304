#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/files/format.h"
#include "client/files/read/read_shape.h"
#include "client/files/write/atomic_file.h"

namespace affskel::client {

/// What the shape can be written as: points as skeletons are, triangles as surfaces are.
std::span<const FileFormat> shape_formats(const ShapeFile& shape);

/// Whether the format has a place for columns beside the coordinates.
bool holds_columns(FileFormat format);

/// The names under which the columns are written, in their order.  Where a name would not read back (with a
/// blank, a comma, a quote, a number sign or a control character; x, y or z; the same twice) it is changed:
/// these characters become '_', and equal names get _2, _3, ... behind them.
std::vector<std::string> written_names(const ShapeFile& shape);

/// Writes a shape in one of its formats.  Points: .csv with a header line and 17 significant digits, .ply
/// binary and .vtp (see write_vtp) with all columns, .off and .xyz coordinates alone.  Surfaces: as
/// write_mesh does, and .ply and .vtp with the columns of the vertices.  Columns have their written_names.
/// @param comments lines for formats that have comments (PLY, OBJ, VTP), without line breaks.
/// @param write takes the bytes, piece by piece.
void write_shape(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 const std::function<void(std::string_view)>& write);

/// The same into a file, which the errors then name.
void write_shape(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 AtomicFile& file);

}  // namespace affskel::client
