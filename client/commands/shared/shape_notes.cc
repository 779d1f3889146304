#include "client/commands/shared/shape_notes.h"

#include <string>
#include <vector>

#include "base/number_text.h"
#include "client/files/read/input_file.h"
#include "client/files/write/shape_writer.h"

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

void tell_lost_curves(Console& console, const ShapeFile& shape, FileFormat format,
                      const std::string& output) {
  if (shape.segments.empty() || holds_curves(format)) return;
  console.note(output + " is without the curves (" + base::counted(shape.segments.size(), "segment") +
               "), for which " + std::string(extension_of(format)) +
               " has no place; .vtp, .ply and .obj have one");
}

std::string counts_text(const ShapeFile& shape) {
  std::string text = base::counted(shape.mesh().points.size(), "point");
  if (shape.is_surface()) text += ", " + base::counted(shape.mesh().triangles.size(), "triangle");
  if (!shape.segments.empty()) text += ", " + base::counted(shape.segments.size(), "segment") + " of curves";
  return text;
}

void tell_what_is_lost(Console& console, const ShapeFile& shape, FileFormat format,
                       const std::string& output) {
  if (!shape.columns.empty() && !holds_columns(format)) {
    std::string names;
    for (const PointColumn& column : shape.columns) names += (names.empty() ? "" : ", ") + column.name;
    console.note(output + " is without the columns " + names + " of " + shape.path);
  }
  tell_lost_curves(console, shape, format, output);
  if (holds_columns(format)) tell_renamed(console, shape, output);
  if (const std::string text = passed_over_text(shape.off); !text.empty())
    console.note(shape.path + ": passed over " + text);
  if (shape.off.polygons_cut > 0) {
    console.note(shape.path + ": " + base::counted(shape.off.polygons_cut, "face") +
                 " of more than three sides " + (shape.off.polygons_cut == 1 ? "was" : "were") +
                 " cut into triangles");
  }
}

}  // namespace affskel::client
