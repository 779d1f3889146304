#include "client/operations/shape_notices.h"

#include <string>
#include <vector>

#include "base/number_text.h"
#include "client/files/read/input_file.h"
#include "client/files/write/shape_writer.h"

namespace affskel::client {
namespace {

Notices renamed_columns(const ShapeFile& shape, const std::string& output) {
  Notices notices;
  const std::vector<std::string> names = written_names(shape);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == shape.columns[i].name) continue;
    notices.push_back(note("COLUMN_RENAMED",
                           "column '" + shape.columns[i].name + "' is written as '" + names[i] +
                               "', so that it can be read back",
                           output));
  }
  return notices;
}

}  // namespace

Notices lost_curves(const ShapeFile& shape, FileFormat format, const std::string& output) {
  if (shape.segments.empty() || holds_curves(format)) return {};
  return {note("CURVES_LOST", output + " is without the curves (" +
                                  base::counted(shape.segments.size(), "segment") + "), for which " +
                                  std::string(extension_of(format)) +
                                  " has no place; .vtp, .ply and .obj have one")};
}

std::string counts_text(const ShapeFile& shape) {
  std::string text = base::counted(shape.mesh().points.size(), "point");
  if (shape.is_surface()) text += ", " + base::counted(shape.mesh().triangles.size(), "triangle");
  if (!shape.segments.empty()) text += ", " + base::counted(shape.segments.size(), "segment") + " of curves";
  return text;
}

Notices lost_in_format(const ShapeFile& shape, FileFormat format, const std::string& output) {
  Notices notices;
  if (!shape.columns.empty() && !holds_columns(format)) {
    std::string names;
    for (const PointColumn& column : shape.columns) names += (names.empty() ? "" : ", ") + column.name;
    notices.push_back(
        note("COLUMNS_LOST", output + " is without the columns " + names + " of " + shape.path));
  }
  append(notices, lost_curves(shape, format, output));
  if (holds_columns(format)) append(notices, renamed_columns(shape, output));
  if (const std::string text = passed_over_text(shape.off); !text.empty())
    notices.push_back(note("PASSED_OVER", "passed over " + text, shape.path));
  if (shape.off.polygons_cut > 0) {
    notices.push_back(note("POLYGONS_CUT",
                           base::counted(shape.off.polygons_cut, "face") + " of more than three sides " +
                               (shape.off.polygons_cut == 1 ? "was" : "were") + " cut into triangles",
                           shape.path));
  }
  return notices;
}

}  // namespace affskel::client
