#include "client/files/write/skeleton_writer.h"

#include "client/base/error.h"
#include "client/files/numbers.h"
#include "client/files/write/vtp_writer.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

// Coordinates of point p, each followed by `separator`.
void append_position(std::string& row, const v1::SkeletonPoints& s, int p, char separator) {
  for (int c = 0; c < 3; ++c) {
    append_exact(row, s.xyz(3 * p + c));
    row.push_back(separator);
  }
}

void write_csv(const v1::SkeletonPoints& s, AtomicFile& file) {
  const bool divergence = !s.divergence().empty() || s.point_size() == 0;
  file.write(divergence ? "x,y,z,E,nx,ny,nz,direction,H\n" : "x,y,z,E,nx,ny,nz,direction\n");
  std::string row;
  for (int p = 0; p < s.point_size(); ++p) {
    row.clear();
    append_position(row, s, p, ',');
    append_exact(row, s.erosion(p));
    for (int c = 0; c < 3; ++c) {
      row.push_back(',');
      append_exact(row, s.normal(3 * p + c));
    }
    row.push_back(',');
    append_integer(row, s.direction(p));
    if (divergence) {
      row.push_back(',');
      append_exact(row, s.divergence(p));
    }
    row.push_back('\n');
    file.write(row);
  }
}

void write_ply(const v1::SkeletonPoints& s, const std::vector<std::string>& comments, AtomicFile& file) {
  const bool divergence = !s.divergence().empty() || s.point_size() == 0;
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) header += "comment " + one_line(comment) + "\n";
  header += "element vertex " + std::to_string(s.point_size()) + "\n";
  for (const char* name : {"x", "y", "z", "E", "nx", "ny", "nz"}) {
    header += std::string("property double ") + name + "\n";
  }
  header += "property int direction\n";
  if (divergence) header += "property double H\n";
  header += "end_header\n";
  file.write(header);
  std::string row;
  for (int p = 0; p < s.point_size(); ++p) {
    row.clear();
    for (int c = 0; c < 3; ++c) append_bytes(row, s.xyz(3 * p + c));
    append_bytes(row, s.erosion(p));
    for (int c = 0; c < 3; ++c) append_bytes(row, s.normal(3 * p + c));
    append_bytes(row, static_cast<std::int32_t>(s.direction(p)));
    if (divergence) append_bytes(row, s.divergence(p));
    file.write(row);
  }
}

void write_as_vtp(const v1::SkeletonPoints& s, const std::vector<std::string>& comments, AtomicFile& file) {
  core::Mesh mesh;
  std::vector<PointColumn> columns = {{"E", false, {s.erosion().begin(), s.erosion().end()}},
                                      {"nx", false, {}},
                                      {"ny", false, {}},
                                      {"nz", false, {}}};
  for (int p = 0; p < s.point_size(); ++p) {
    mesh.points.push_back({s.xyz(3 * p), s.xyz(3 * p + 1), s.xyz(3 * p + 2)});
    for (int c = 0; c < 3; ++c)
      columns[static_cast<std::size_t>(1 + c)].values.push_back(s.normal(3 * p + c));
  }
  columns.push_back({"direction", true, {s.direction().begin(), s.direction().end()}});
  if (!s.divergence().empty() || s.point_size() == 0) {
    columns.push_back({"H", false, {s.divergence().begin(), s.divergence().end()}});
  }
  write_vtp(mesh, columns, comments, [&](std::string_view bytes) { file.write(bytes); });
}

void write_coordinates(const v1::SkeletonPoints& s, AtomicFile& file) {
  std::string row;
  for (int p = 0; p < s.point_size(); ++p) {
    row.clear();
    append_position(row, s, p, ' ');
    row.back() = '\n';
    file.write(row);
  }
}

bool consistent(const v1::SkeletonPoints& s) {
  const int n = s.point_size();
  return s.xyz_size() == 3 * n && s.erosion_size() == n && s.normal_size() == 3 * n &&
         s.direction_size() == n;
}

}  // namespace

v1::SkeletonPoints parse_skeleton(const std::string& bytes) {
  v1::SkeletonPoints s;
  if (!s.ParseFromString(bytes) || !consistent(s) || s.divergence_size() != s.point_size()) {
    throw ClientError(ExitCode::kInternal, "the server sent a damaged skeleton");
  }
  return s;
}

v1::SkeletonPoints parse_eroded_points(const std::string& bytes) {
  v1::SkeletonPoints s;
  if (!s.ParseFromString(bytes) || !consistent(s) || s.divergence_size() != 0) {
    throw ClientError(ExitCode::kInternal, "the server sent a damaged eroded solid");
  }
  return s;
}

void write_skeleton(FileFormat format, const v1::SkeletonPoints& skeleton,
                    const std::vector<std::string>& comments, AtomicFile& file) {
  switch (format) {
    case FileFormat::kCsv:
      return write_csv(skeleton, file);
    case FileFormat::kPly:
      return write_ply(skeleton, comments, file);
    case FileFormat::kVtp:
      return write_as_vtp(skeleton, comments, file);
    case FileFormat::kOff:
      file.write("OFF\n" + std::to_string(skeleton.point_size()) + " 0 0\n");
      return write_coordinates(skeleton, file);
    case FileFormat::kXyz:
      return write_coordinates(skeleton, file);
    default:
      throw ClientError(ExitCode::kInternal, "no skeleton writer for " + std::string(extension_of(format)));
  }
}

}  // namespace affskel::client
