#include "client/base/up_axis.h"

#include <algorithm>
#include <cmath>

#include "client/base/mesh_box.h"

namespace affskel::client {
namespace {

using core::Vec3;

constexpr double kClearlyLonger = 1.25;  // a body's height against its arms hanging obliquely: 1.5
constexpr double kThin = 0.5;            // a body's depth against its height: 0.15 to 0.3
constexpr double kEven = 0.02;           // bodies of 292 to 107,024 triangles: 0.005 at most
constexpr double kUneven = 0.03;         // the same, along their height: 0.06 to 0.085

// From the middle of the box to the centre of volume, as shares of its sides; zero without volume.
Vec3 unevenness(const core::Mesh& mesh, const Box& box) {
  const Vec3 middle = box.centre(), size = box.size();
  double volume = 0;
  Vec3 moment{};
  for (const core::Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]] - middle, b = mesh.points[t[1]] - middle, c = mesh.points[t[2]] - middle;
    const double part = core::dot(a, core::cross(b, c));
    volume += part;
    moment = moment + (part / 4) * (a + (b + c));
  }
  if (!(std::fabs(volume) > 0 && size.x > 0 && size.y > 0 && size.z > 0)) return {};
  return {moment.x / volume / size.x, moment.y / volume / size.y, moment.z / volume / size.z};
}

}  // namespace

UpAxis up_axis(const core::Mesh& mesh) {
  const Box box = mesh_box(mesh);
  const Vec3 size = box.size();
  if (size.y > kClearlyLonger * std::max(size.x, size.z)) return UpAxis::kY;
  if (size.z >= kThin * std::min(size.x, size.y)) return UpAxis::kZ;
  const Vec3 uneven = unevenness(mesh, box);
  return std::fabs(uneven.x) < kEven && std::fabs(uneven.y) >= kUneven ? UpAxis::kY : UpAxis::kZ;
}

char up_letter(UpAxis up) {
  return up == UpAxis::kX ? 'x' : up == UpAxis::kY ? 'y' : 'z';
}

Stance stance(UpAxis up) {
  switch (up) {
    case UpAxis::kX:
      return {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
    case UpAxis::kY:
      return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case UpAxis::kZ:
      break;
  }
  return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
}

}  // namespace affskel::client
