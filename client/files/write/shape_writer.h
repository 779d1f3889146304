#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "client/base/shape_file.h"
#include "client/files/format.h"

namespace affskel::client {

/// What the shape can be written as: points as skeletons are, triangles as surfaces are.
std::span<const FileFormat> shape_formats(const ShapeFile& shape);

/// Whether the format has a place for columns beside the coordinates.
bool holds_columns(FileFormat format);

/// Whether a surface in this format has a place for curves.
bool holds_curves(FileFormat format);

/// The names under which the columns are written, in their order.  Where a name would not read back (with a
/// blank, a comma, a quote, a number sign or a control character; x, y or z; the same twice) it is changed:
/// these characters become '_', and equal names get _2, _3, ... behind them.
std::vector<std::string> written_names(const ShapeFile& shape);

/// Takes the bytes of a file, piece by piece.
using WriteBytes = std::function<void(std::string_view)>;

/// Writes the points of a shape in one of skeleton_formats(): .csv with a header line and 17 significant
/// digits, .ply binary and .vtp with all columns under their written_names, .off and .xyz coordinates alone.
/// @param comments lines for formats that have comments (PLY, VTP, OFF), without line breaks.
/// @throws ClientError kLimit when there are more points than the format can count.
void write_points(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                  const WriteBytes& write);

/// Writes a surface, be it empty, in one of surface_formats(), and its curves where it holds_curves(): .off
/// and .obj as text that reads back exactly, .ply binary with double coordinates and the columns of the
/// vertices (and what shows E, see PLY's writer), .vtp with the same as arrays, .stl binary (single
/// precision, which is all that STL has).  Triangles with two equal corners in it are left out, other slivers
/// that it makes flat are written as they are; the surface stays closed.
/// @param comments lines for formats that have comments (PLY, OBJ, VTP, OFF), without line breaks; of these
/// "job ID" and "mesh_sha256 HASH", the latter's first half, also find room in the 80 bytes of STL's header.
/// @throws ClientError kLimit when the mesh has more elements than the format can count, and for .stl when a
/// coordinate does not fit into single precision or when triangles would become flat in it that hold more
/// than 1e-6 of the area or all the area round a vertex: the mesh or a part of it is too small, or too far
/// from the origin for its size.
void write_surface(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                   const WriteBytes& write);

/// Writes the lines of a curve skeleton in one of curve_file_formats(): .vtp, .ply and .obj as write_surface does,
/// their vertices in .csv and .xyz as write_points does, and as a graph of nodes (ends, and places where lines meet)
/// and branches: .json (UTF-8, one object), .graphml (undirected, one edge a branch), .swc (a row per vertex, "id type
/// x y z radius parent" as Cannon, Turner, Pyapali and Turner 1998 have it: trees rooted where E is greatest, so that a
/// loop is cut where it closes).
/// @param shape with the columns E, radius, distance and share.
void write_curve(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 const WriteBytes& write);

/// One or the other, as the shape is.
void write_shape(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 const WriteBytes& write);

/// Lets `writer`, which calls one of these, write into a file, which its errors then name.
void write_into(base::AtomicFile& file, const std::function<void(const WriteBytes&)>& writer);

}  // namespace affskel::client
