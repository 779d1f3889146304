#pragma once

#include <string>
#include <vector>

#include "client/files/write/shape_writer.h"

namespace affskel::client {

// One writer per format; see write_points and write_surface.  `names` are what the columns are called in the
// file.

/// A header line and a row per point.
void write_csv(const ShapeFile& shape, const std::vector<std::string>& names, const WriteBytes& write);
/// A row of coordinates per point, separated by blanks.
void write_xyz(const ShapeFile& shape, const WriteBytes& write);
/// @param faces whether there is a list of faces, be it empty.
void write_ply(const ShapeFile& shape, const std::vector<std::string>& names, bool faces,
               const std::vector<std::string>& comments, const WriteBytes& write);
void write_obj(const ShapeFile& shape, const std::vector<std::string>& comments, const WriteBytes& write);
void write_stl(const core::Mesh& mesh, const std::vector<std::string>& comments, const WriteBytes& write);
/// A VTK XML PolyData file, as ParaView and VTK >= 6 read it: triangles as polygons, curves as polylines,
/// points alone as one vertex each, coordinates as Float64; arrays inline in base64, little-endian, with 64
/// bit lengths. Columns become point arrays, whole ones Int32 or UInt32 where all values fit, the others
/// Float64; three in a row that belong together become one array of three (see array_of_columns).  E is the
/// active array, by which ParaView colours; columns of triangles become cell arrays.  Comments become the strings of the field array "comment".
/// @param columns the shape's, under their names in the file.
void write_vtp(const ShapeFile& shape, const std::vector<PointColumn>& columns,
               const std::vector<std::string>& comments, const WriteBytes& write);

void write_curve_json(const ShapeFile& shape, const std::vector<std::string>& comments,
                      const WriteBytes& write);
void write_curve_graphml(const ShapeFile& shape, const std::vector<std::string>& comments,
                         const WriteBytes& write);
void write_swc(const ShapeFile& shape, const std::vector<std::string>& comments, const WriteBytes& write);

}  // namespace affskel::client
