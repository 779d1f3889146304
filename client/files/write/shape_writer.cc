#include "client/files/write/shape_writer.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>

#include "client/base/error.h"
#include "client/files/write/shape_writers.h"
#include "client/text/printable.h"
#include "core/text/off_file.h"

namespace affskel::client {
namespace {

constexpr std::size_t kMaxElements = std::numeric_limits<std::int32_t>::max();  // of each kind

// Words without what separates or ends them in a header line of CSV or PLY.
std::string safe_name(std::string name) {
  for (char& c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code <= ' ' || code == 127 || c == ',' || c == '#' || c == '"' || c == '\'') c = '_';
  }
  return name.empty() ? "_" : name;
}

// The columns under the names that read back.
std::vector<PointColumn> columns_as_written(const ShapeFile& shape) {
  std::vector<PointColumn> columns = shape.columns;
  const std::vector<std::string> names = written_names(shape);
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c].name = names[c];
  return columns;
}

std::string off_comments(const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + one_line(comment) + "\n";
  return text;
}

// The comments stand behind the word that begins the file.
void write_off(const core::Mesh& mesh, const std::vector<std::string>& comments, const WriteBytes& write) {
  const std::string text = core::write_off(mesh);
  const std::size_t word = text.find('\n') + 1;
  write(text.substr(0, word) + off_comments(comments));
  write(std::string_view(text).substr(word));
}

}  // namespace

std::span<const FileFormat> shape_formats(const ShapeFile& shape) {
  return shape.is_surface() ? surface_formats() : skeleton_formats();
}

bool holds_columns(FileFormat format) {
  return format == FileFormat::kCsv || format == FileFormat::kPly || format == FileFormat::kVtp;
}

bool holds_curves(FileFormat format) {
  return format == FileFormat::kPly || format == FileFormat::kObj || format == FileFormat::kVtp;
}

std::vector<std::string> written_names(const ShapeFile& shape) {
  // Names that stay go first, so that none of them gives way to a changed one.
  std::set<std::string> taken = {"x", "y", "z"};
  std::vector<std::string> names(shape.columns.size());
  for (const bool keeps : {true, false}) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string safe = safe_name(shape.columns[i].name);
      const bool stays = safe == shape.columns[i].name && taken.count(safe) == 0;
      if (!names[i].empty() || (keeps && !stays)) continue;
      names[i] = safe;
      for (int n = 2; !taken.insert(names[i]).second; ++n) names[i] = safe + "_" + std::to_string(n);
    }
  }
  return names;
}

void write_points(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                  const WriteBytes& write) {
  if (shape.mesh().points.size() > kMaxElements) {
    throw ClientError(ExitCode::kLimit, "the shape has too many points for this format");
  }
  switch (format) {
    case FileFormat::kCsv:
      return write_csv(shape, written_names(shape), write);
    case FileFormat::kPly:
      return write_ply(shape, written_names(shape), false, comments, write);
    case FileFormat::kVtp:
      return write_vtp(shape, columns_as_written(shape), comments, write);
    case FileFormat::kOff:
      write("OFF\n" + off_comments(comments) + std::to_string(shape.mesh().points.size()) + " 0 0\n");
      return write_xyz(shape, write);
    case FileFormat::kXyz:
      return write_xyz(shape, write);
    default:
      throw ClientError(ExitCode::kInternal, "no point writer for " + std::string(extension_of(format)));
  }
}

void write_surface(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                   const WriteBytes& write) {
  const core::Mesh& mesh = shape.mesh();
  if (std::max({mesh.points.size(), mesh.triangles.size(), shape.segments.size()}) > kMaxElements) {
    throw ClientError(ExitCode::kLimit, "the mesh has too many elements for this format");
  }
  switch (format) {
    case FileFormat::kOff:
      return write_off(mesh, comments, write);
    case FileFormat::kPly:
      return write_ply(shape, written_names(shape), true, comments, write);
    case FileFormat::kObj:
      return write_obj(shape, comments, write);
    case FileFormat::kStl:
      return write_stl(mesh, comments, write);
    case FileFormat::kVtp:
      return write_vtp(shape, columns_as_written(shape), comments, write);
    default:
      throw ClientError(ExitCode::kInternal, "no mesh writer for " + std::string(extension_of(format)));
  }
}

void write_curve(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 const WriteBytes& write) {
  switch (format) {
    case FileFormat::kJson:
      return write_curve_json(shape, comments, write);
    case FileFormat::kGraphMl:
      return write_curve_graphml(shape, comments, write);
    case FileFormat::kSwc:
      return write_swc(shape, comments, write);
    case FileFormat::kCsv:
    case FileFormat::kXyz:
      return write_points(format, shape, comments, write);
    default:
      return write_surface(format, shape, comments, write);
  }
}

void write_shape(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 const WriteBytes& write) {
  if (shape.is_surface()) return write_surface(format, shape, comments, write);
  write_points(format, shape, comments, write);
}

void write_into(base::AtomicFile& file, const std::function<void(const WriteBytes&)>& writer) {
  try {
    writer([&](std::string_view bytes) { file.write(bytes); });
  } catch (const ClientError& error) {
    if (!error.file().empty()) throw;
    throw ClientError(error.exit_code(), error.what(), file.target());
  }
}

}  // namespace affskel::client
