// Points as rows of numbers: .csv with a header line, .xyz and .dat without.
#include <array>
#include <set>
#include <utility>

#include "core/files/read/shape_parsers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

std::vector<std::string_view> fields_of(std::string_view row) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0;;) {
    const std::size_t comma = row.find(',', at);
    fields.push_back(without_blanks(row.substr(at, comma - at)));
    if (comma == std::string_view::npos) return fields;
    at = comma + 1;
  }
}

// Which columns of the table are the coordinates, and which of the file's columns the others.
struct Header {
  std::array<std::size_t, 3> coordinate{};
  std::vector<std::pair<std::size_t, std::size_t>> other;  // place in the row, column of the file
  std::size_t width = 0;
};

Header read_header(const std::vector<std::string_view>& names, std::uint64_t line, ShapeFile& file) {
  Header header;
  header.width = names.size();
  std::array<bool, 3> found{};
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!seen.insert(names[i]).second) {
      fail_at(line, "two columns are called " + quoted_excerpt(names[i]));
    }
    if (names[i] == "x" || names[i] == "y" || names[i] == "z") {
      const auto c = static_cast<std::size_t>(names[i].front() - 'x');
      header.coordinate[c] = i;
      found[c] = true;
      continue;
    }
    if (names[i].empty()) fail_at(line, "column " + std::to_string(i + 1) + " has no name");
    header.other.emplace_back(i, file.columns.size());
    file.columns.push_back({std::string(names[i]), names[i] == "direction", {}});
  }
  if (!found[0] || !found[1] || !found[2]) {
    fail_at(line, "the first line must name the columns, among them x, y and z");
  }
  return header;
}

void add_row(const std::vector<std::string_view>& words, const Header& header, std::uint64_t line,
             ShapeFile& file) {
  const auto coordinate = [&](std::size_t c) {
    return parse_finite(words[header.coordinate[c]], line, "coordinate");
  };
  file.off.mesh.points.push_back({coordinate(0), coordinate(1), coordinate(2)});
  file.off.vertex_line.push_back(static_cast<std::uint32_t>(line));
  for (const auto& [place, column] : header.other) {
    PointColumn& target = file.columns[column];
    target.values.push_back(parse_number(words[place], line, target.name.c_str()));
  }
}

// Rows without a header whose widths are possible; the first row decides which it is.
ShapeFile parse_plain(std::string_view bytes, const std::vector<std::vector<std::string_view>>& layouts,
                      const std::string& expected) {
  ShapeFile file;
  TextRows rows(bytes);
  Header header;
  while (rows.next()) {
    const std::size_t width = rows.words().size();
    if (header.width == 0) {
      for (const auto& layout : layouts) {
        if (layout.size() == width) header = read_header(layout, rows.line(), file);
      }
    }
    if (width != header.width) {
      fail_at(rows.line(), "a row of " + std::to_string(width) + " words; expected " + expected +
                               (header.width == 0 ? "" : ", the same in every row"));
    }
    add_row(rows.words(), header, rows.line(), file);
  }
  return file;
}

}  // namespace

ShapeFile parse_csv(std::string_view bytes) {
  ShapeFile file;
  TextRows rows(bytes);
  if (!rows.next()) fail_at(1, "the file is empty; expected a header line with x, y and z");
  const Header header = read_header(fields_of(rows.text()), rows.line(), file);
  while (rows.next()) {
    const std::vector<std::string_view> fields = fields_of(rows.text());
    if (fields.size() != header.width) {
      fail_at(rows.line(), "a row of " + std::to_string(fields.size()) + " values; the header names " +
                               std::to_string(header.width));
    }
    add_row(fields, header, rows.line(), file);
  }
  return file;
}

ShapeFile parse_dat(std::string_view bytes) {
  return parse_plain(bytes, {{"x", "y", "z", "E", "nx", "ny", "nz"}}, "x y z E nx ny nz");
}

ShapeFile parse_xyz(std::string_view bytes) {
  return parse_plain(bytes, {{"x", "y", "z"}, {"x", "y", "z", "nx", "ny", "nz"}}, "x y z or x y z nx ny nz");
}

}  // namespace affskel::core
