#include "client/commands/shapes.h"

#include <string>
#include <vector>

#include "client/exporters/shape_writer.h"

namespace affskel::client {
namespace {

void tell_renamed(Console& console, const ShapeFile& shape, const std::string& output) {
  const std::vector<std::string> names = written_names(shape);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == shape.columns[i].name) continue;
    console.note(output + ": column '" + shape.columns[i].name + "' is written as '" + names[i] +
                 "', so that it can be read back");
  }
}

}  // namespace

std::string counts_text(const ShapeFile& shape) {
  std::string text = std::to_string(shape.mesh().points.size()) + " points";
  if (shape.is_surface()) text += ", " + std::to_string(shape.mesh().triangles.size()) + " triangles";
  return text;
}

void tell_what_is_lost(Console& console, const ShapeFile& shape, FileFormat format,
                       const std::string& output) {
  if (!shape.columns.empty() && !holds_columns(format)) {
    std::string names;
    for (const PointColumn& column : shape.columns) names += (names.empty() ? "" : ", ") + column.name;
    console.note(output + " is without the columns " + names + " of " + shape.path);
  }
  if (holds_columns(format)) tell_renamed(console, shape, output);
  if (shape.off.polygons_cut > 0) {
    console.note(shape.path + ": " + std::to_string(shape.off.polygons_cut) +
                 " faces of more than three sides were cut into triangles");
  }
}

}  // namespace affskel::client
