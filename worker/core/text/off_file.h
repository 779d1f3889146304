#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Rows of a file that were passed over, all that begin with the same word, or other things of one kind.
struct PassedOver {
  std::string word;
  std::uint64_t rows = 0;
  std::uint64_t first_line = 0;  ///< counted from 1; 0 = the file has no lines
  const char* each = "row";      ///< what is counted: "1 row of vn", "2 objects of type support"
};

/// A mesh with the lines it came from, so that later messages can name the place.
struct OffMesh {
  Mesh mesh;
  std::vector<std::uint32_t> vertex_line;    ///< per vertex, counted from 1
  std::vector<std::uint32_t> triangle_line;  ///< per triangle: the line of its polygon
  std::uint64_t polygons = 0;                ///< faces in the file, of any number of sides >= 3
  std::uint64_t polygons_cut = 0;            ///< faces with more than three sides, cut into triangles
  double uneven_distance = 0;                ///< of these, the largest Unevenness::distance, mesh units
  std::uint64_t uneven_line = 0;             ///< and its line, 0 = none
  double uneven_volume = 0;                  ///< of these, the sum of Unevenness::volume, mesh units cubed
  std::vector<PassedOver> passed_over;       ///< of formats that hold more than a mesh, in the file's order
  std::string unit;  ///< of lengths, where the file names one: "millimeter", "inch", ...
};

/// Cuts a polygon into triangles (see cut_polygon), and counts it where it has more than three corners; of those with four
/// the first triangle goes to `quads`.
/// @param corners three at least, vertices of the mesh.
/// @return one that it has twice, as a triangle alone may: then nothing is added.
std::optional<std::uint32_t> add_polygon(OffMesh& off, std::span<const std::uint32_t> corners,
                                         std::uint64_t line, std::vector<std::uint32_t>& quads);

/// Reads a Geomview OFF file in text form, strictly: header [ST][C][N][4]OFF, counts on the same or on the
/// next line (the edge count may be absent), `#` comments, lines as TextRows has them; per vertex three finite
/// numbers (x y z w under 4OFF, where x/w y/w z/w is the place) plus what the header promises, or under the
/// header OFF three or four more on every row, which several viewers write for colours; per face its size,
/// indices and optional colours.  Polygons are cut into triangles (see cut_polygon).  A triangle may name a
/// vertex twice, a larger polygon not.  The file must end after the last face.
/// @throws CoreError kBadInput with line and cause for everything else (binary, nOFF, decimal
///   commas, NUL bytes, line ends of two kinds, trailing rows, indices out of range or not integral, NaN, infinity);
///   kLimit for counts above 2^28, before anything is allocated; kCancelled when the context asks to stop.
OffMesh read_off(std::string_view bytes, ExecutionContext* context = nullptr);

/// Text of an OFF file with the shortest decimals that read back exactly.
std::string write_off(const Mesh& mesh);

}  // namespace affskel::core
