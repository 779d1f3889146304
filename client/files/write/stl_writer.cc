#include <cstdint>

#include "base/coding.h"
#include "client/files/numbers.h"
#include "client/files/write/shape_writers.h"
#include "client/files/write/single_precision.h"

namespace affskel::client {

void write_stl(const core::Mesh& mesh, const WriteBytes& write) {
  check_fits_stl(mesh);
  // A binary header must not begin with "solid", which marks the text variant.
  std::string text = "triangle mesh, units as submitted";
  text.resize(80, ' ');
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
