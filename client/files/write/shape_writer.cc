#include "client/files/write/shape_writer.h"

#include <limits>
#include <set>

#include "client/base/error.h"
#include "client/files/numbers.h"
#include "client/files/write/mesh_writer.h"
#include "client/files/write/stored_type.h"
#include "client/files/write/vtp_writer.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

using Write = std::function<void(std::string_view)>;

void write_csv(const ShapeFile& shape, const Write& write) {
  std::string row = "x,y,z";
  for (const std::string& name : written_names(shape)) row += "," + name;
  write(row + "\n");
  for (std::size_t i = 0; i < shape.mesh().points.size(); ++i) {
    row.clear();
    for (int c = 0; c < 3; ++c) {
      if (c > 0) row.push_back(',');
      append_exact(row, shape.mesh().points[i][c]);
    }
    for (const PointColumn& column : shape.columns) {
      row.push_back(',');
      append_exact(row, column.values[i]);
    }
    row.push_back('\n');
    write(row);
  }
}

void write_coordinates(const ShapeFile& shape, const Write& write) {
  std::string row;
  for (const core::Vec3& p : shape.mesh().points) {
    row.clear();
    for (int c = 0; c < 3; ++c) {
      append_exact(row, p[c]);
      row.push_back(c < 2 ? ' ' : '\n');
    }
    write(row);
  }
}

// Words without what separates or ends them in a header line of CSV or PLY.
std::string safe_name(std::string name) {
  for (char& c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code <= ' ' || code == 127 || c == ',' || c == '#' || c == '"' || c == '\'') c = '_';
  }
  return name.empty() ? "_" : name;
}

std::string ply_header(const ShapeFile& shape, const std::vector<Stored>& stored,
                       const std::vector<std::string>& comments) {
  constexpr const char* kTypes[] = {"int", "uint", "double"};
  const std::vector<std::string> names = written_names(shape);
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) text += "comment " + one_line(comment) + "\n";
  text += "element vertex " + std::to_string(shape.mesh().points.size()) +
          "\nproperty double x\nproperty double y\nproperty double z\n";
  for (std::size_t i = 0; i < stored.size(); ++i) {
    text += std::string("property ") + kTypes[static_cast<std::size_t>(stored[i])] + " " + names[i] + "\n";
  }
  if (shape.is_surface()) {
    text += "element face " + std::to_string(shape.mesh().triangles.size()) +
            "\nproperty list uchar int vertex_indices\n";
  }
  return text + "end_header\n";
}

void write_ply(const ShapeFile& shape, const std::vector<std::string>& comments, const Write& write) {
  std::vector<Stored> stored;
  for (const PointColumn& column : shape.columns) stored.push_back(stored_as(column));
  write(ply_header(shape, stored, comments));
  std::string row;
  for (std::size_t i = 0; i < shape.mesh().points.size(); ++i) {
    row.clear();
    for (int c = 0; c < 3; ++c) append_bytes(row, shape.mesh().points[i][c]);
    for (std::size_t k = 0; k < stored.size(); ++k) {
      append_stored(row, shape.columns[k].values[i], stored[k]);
    }
    write(row);
  }
  for (const core::Triangle& t : shape.mesh().triangles) {
    row.clear();
    append_bytes(row, std::uint8_t{3});
    for (const std::uint32_t corner : t) append_bytes(row, static_cast<std::int32_t>(corner));
    write(row);
  }
}

std::vector<PointColumn> columns_as_written(const ShapeFile& shape) {
  std::vector<PointColumn> columns = shape.columns;
  const std::vector<std::string> names = written_names(shape);
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c].name = names[c];
  return columns;
}

}  // namespace

std::span<const FileFormat> shape_formats(const ShapeFile& shape) {
  return shape.is_surface() ? surface_formats() : skeleton_formats();
}

bool holds_columns(FileFormat format) {
  return format == FileFormat::kCsv || format == FileFormat::kPly || format == FileFormat::kVtp;
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

void write_shape(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 const Write& write) {
  if (shape.mesh().points.size() > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw ClientError(ExitCode::kLimit, "the shape has too many points for this format");
  }
  if (format == FileFormat::kPly) return write_ply(shape, comments, write);
  if (format == FileFormat::kVtp) {
    return write_vtp(shape.mesh(), columns_as_written(shape), comments, write);
  }
  if (shape.is_surface()) return write_mesh(format, shape.mesh(), comments, write);
  switch (format) {
    case FileFormat::kCsv:
      return write_csv(shape, write);
    case FileFormat::kOff:
      write("OFF\n" + std::to_string(shape.mesh().points.size()) + " 0 0\n");
      return write_coordinates(shape, write);
    case FileFormat::kXyz:
      return write_coordinates(shape, write);
    default:
      throw ClientError(ExitCode::kInternal, "no point writer for " + std::string(extension_of(format)));
  }
}

void write_shape(FileFormat format, const ShapeFile& shape, const std::vector<std::string>& comments,
                 AtomicFile& file) {
  try {
    write_shape(format, shape, comments, [&](std::string_view bytes) { file.write(bytes); });
  } catch (const ClientError& error) {
    if (!error.file().empty()) throw;
    throw ClientError(error.exit_code(), error.what(), file.target());
  }
}

}  // namespace affskel::client
