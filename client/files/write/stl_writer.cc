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

}  // namespace

void write_stl(const core::Mesh& mesh, const std::vector<std::string>& comments, const WriteBytes& write) {
  check_fits_stl(mesh);
  std::string text = stl_header(comments);
  base::append(text, static_cast<std::uint32_t>(mesh.triangles.size()));
  write(text);
  for (const core::Triangle& t : mesh.triangles) {
    const core::Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    core::Vec3 normal = core::cross(b - a, c - a);
    const double length = core::norm(normal);
    if (length > 0) normal = (1 / length) * normal;
    text.clear();
    for (const core::Vec3& v : {normal, a, b, c}) {
      for (int k = 0; k < 3; ++k) base::append(text, static_cast<float>(v[k]));
    }
    base::append(text, std::uint16_t{0});
    write(text);
  }
}

}  // namespace affskel::client
