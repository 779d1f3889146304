#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/shape_file.h"

namespace affskel::core {

// One parser per format; see parse_shape.  All leave `path` empty and throw CoreError kBadInput, with the line for text;
// those of glTF and 3MF kLimit, too, when they place meshes so often that they grow without bound.

ShapeFile parse_csv(std::string_view bytes);
ShapeFile parse_dat(std::string_view bytes);
ShapeFile parse_xyz(std::string_view bytes);
ShapeFile parse_ply(std::string_view bytes);
ShapeFile parse_obj(std::string_view bytes);
ShapeFile parse_stl(std::string_view bytes);
ShapeFile parse_vtp(std::string_view bytes);
ShapeFile parse_binary_off(std::string_view bytes);
ShapeFile parse_gltf(std::string_view bytes);
ShapeFile parse_3mf(std::string_view bytes);

/// Whether the first line is that of a binary OFF file.
bool is_binary_off(std::string_view bytes);

/// Whether the size is what the count of triangles in a binary STL file makes it.
bool is_binary_stl(std::string_view bytes);

/// What everything behind the parsers can number.
/// @throws CoreError kLimit for more than 2^28 of either.
void check_counts(std::uint64_t points, std::uint64_t triangles);

/// Whether the first word is that of STL as text, in capitals or not.
bool is_text_stl(std::string_view bytes);

/// Cuts a polygon into triangles of `file`.
/// @param place names it in messages, @param line of it, 0 = none.
/// @throws CoreError kBadInput when it has less than three corners, one out of range, or, of more than three,
///   one twice.
void add_polygon(ShapeFile& file, const std::vector<std::int64_t>& corners, const std::string& place,
                 std::uint64_t line);

/// A surface of triangles by three corners each, for formats that repeat vertices: corners at one place (0 and -0 are
/// the same) become one vertex, in the order in which they come first.
class CornerSurface {
 public:
  CornerSurface();
  /// The next corner, finite.
  void add(const Vec3& corner);
  ShapeFile take();

 private:
  std::size_t slot_of(const Vec3& corner) const;
  void grow();

  std::uint64_t seed_ = 0;  // drawn anew, so that no file can be made whose places all meet in the table
  Mesh mesh_;
  std::uint32_t corners_ = 0;         // of the last triangle
  std::vector<std::uint32_t> table_;  // open addressing by place: a vertex + 1, or 0
};

/// Adds the segments of a polyline to `file`; those of no length by index are left out.
/// @param place names it in messages, @param line of it, 0 = none.
/// @throws CoreError kBadInput when it has less than two vertices or one out of range.
void add_polyline(ShapeFile& file, const std::vector<std::int64_t>& vertices, const std::string& place,
                  std::uint64_t line);

}  // namespace affskel::core
