#include <algorithm>
#include <array>
#include <cstdint>

#include "base/coding.h"
#include "client/files/write/shape_writers.h"
#include "client/files/write/single_precision.h"

namespace affskel::client {

namespace {

// What the 80 bytes have room for.  They must not begin with "solid", which marks the text variant.
std::string stl_header(const std::vector<std::string>& comments) {
  constexpr std::size_t kSize = 80, kHash = 16;
  std::string text;
  for (const std::string& comment : comments) {
    if (comment.starts_with("job ")) text += comment + ", ";
    const std::string hash = "mesh_sha256 ";
    if (comment.starts_with(hash)) text += "mesh " + comment.substr(hash.size(), kHash) + ", ";
  }
  text = (text.empty() ? "triangle mesh, " : text) + "units as submitted";
  text.resize(kSize, ' ');
  return text;
}

using StlCorner = std::array<float, 3>;

StlCorner stl_corner(const core::Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

// Of these nothing is left, and what they joined still joins: readers merge equal corners.
bool has_equal_corners(const std::array<StlCorner, 3>& corners) {
  return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

std::array<StlCorner, 3> corners_of(const core::Mesh& mesh, const core::Triangle& t) {
  return {stl_corner(mesh.points[t[0]]), stl_corner(mesh.points[t[1]]), stl_corner(mesh.points[t[2]])};
}

}  // namespace

void write_stl(const core::Mesh& mesh, const std::vector<std::string>& comments, const WriteBytes& write) {
  check_fits_stl(mesh);
  std::string text = stl_header(comments);
  const auto flat = std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const core::Triangle& t) {
    return has_equal_corners(corners_of(mesh, t));
  });
  base::append(text, static_cast<std::uint32_t>(mesh.triangles.size() - static_cast<std::size_t>(flat)));
  write(text);
  for (const core::Triangle& t : mesh.triangles) {
    const core::Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    core::Vec3 normal = core::cross(b - a, c - a);
    const double length = core::norm(normal);
    if (length > 0) normal = (1 / length) * normal;
    const std::array<StlCorner, 3> corners = corners_of(mesh, t);
    if (has_equal_corners(corners)) continue;
    text.clear();
    for (const StlCorner& v : {stl_corner(normal), corners[0], corners[1], corners[2]})
      for (const float coordinate : v) base::append(text, coordinate);
    base::append(text, std::uint16_t{0});
    write(text);
  }
}

}  // namespace affskel::client
