#include "core/files/read/shape_parsers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

// "7", "7/1", "7//3" or "-1" (the last vertex so far), from 1; an index from 0.
std::int64_t corner_of(std::string_view word, std::size_t known, const std::string& what,
                       std::uint64_t line) {
  std::string_view digits = word.substr(0, word.find('/'));
  const bool from_end = digits.starts_with('-');
  if (from_end) digits.remove_prefix(1);
  const std::uint64_t number = parse_count(digits, line, "a vertex index");
  if (number == 0 || number > known) {
    fail_at(line, what + " uses vertex " + quoted_excerpt(word) + "; " + std::to_string(known) +
                      " vertices are known here, counted from 1");
  }
  return static_cast<std::int64_t>(from_end ? known - number : number - 1);
}

}  // namespace

ShapeFile parse_obj(std::string_view bytes) {
  ShapeFile file;
  TextRows rows(bytes);
  std::vector<std::int64_t> corners;
  const auto read_corners = [&](const std::string& what) {
    corners.clear();
    for (std::size_t i = 1; i < rows.words().size(); ++i)
      corners.push_back(corner_of(rows.words()[i], file.off.mesh.points.size(), what, rows.line()));
  };
  while (rows.next()) {
    const auto& words = rows.words();
    if (words[0] == "v") {
      if (words.size() < 4) fail_at(rows.line(), "a vertex needs three coordinates");
      const auto coordinate = [&](std::size_t i) {
        return parse_finite(words[i], rows.line(), "coordinate");
      };
      file.off.mesh.points.push_back({coordinate(1), coordinate(2), coordinate(3)});
      file.off.vertex_line.push_back(static_cast<std::uint32_t>(rows.line()));
    } else if (words[0] == "f") {
      read_corners("a face");
      add_polygon(file, corners, "the face", rows.line());
      file.off.triangle_line.resize(file.off.mesh.triangles.size(), static_cast<std::uint32_t>(rows.line()));
      ++file.off.polygons;
      if (corners.size() > 3) ++file.off.polygons_cut;
    } else if (words[0] == "l") {
      read_corners("a line");
      add_polyline(file, corners, "the line", rows.line());
    }
  }
  if (file.off.mesh.points.empty()) fail_at(rows.line(), "no vertices (rows that begin with v)");
  return file;
}

}  // namespace affskel::core
