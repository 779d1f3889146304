#include "client/artifacts/solid_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "client/base/error.h"

namespace affskel::client {
namespace {

void require(bool holds, const char* what) {
  if (!holds)
    throw ClientError(ExitCode::kInternal,
                      std::string("the server sent damaged parts of the solid: ") + what);
}

bool all_between(const google::protobuf::RepeatedField<std::uint32_t>& values, std::uint32_t low,
                 std::uint32_t high) {
  return std::all_of(values.begin(), values.end(),
                     [&](std::uint32_t value) { return value >= low && value <= high; });
}

}  // namespace

v1::SolidParts parse_solid_parts(const std::string& bytes) {
  v1::SolidParts message;
  require(message.ParseFromString(bytes), "unreadable");
  const auto parts = static_cast<std::uint32_t>(message.parts_size());
  const auto& surface = message.surface();
  const int triangles = surface.corners_size() / 3;
  require(surface.xyz_size() % 3 == 0 && surface.corners_size() % 3 == 0 && triangles > 0, "odd numbers");
  require(all_between(surface.corners(), 0, static_cast<std::uint32_t>(surface.xyz_size() / 3) - 1),
          "a corner out of range");
  require(std::all_of(message.thickness().begin(), message.thickness().end(),
                      [](double thickness) { return std::isfinite(thickness); }),
          "a thickness that is no number");
  require(message.triangle_part_size() == triangles && message.thickness_size() == triangles,
          "a triangle without its values");
  require(all_between(message.triangle_part(), 1, parts) && all_between(message.point_part(), 1, parts),
          "a part out of range");
  require(message.greatest_place_size() == 3, "the greatest E without its place");
  const auto vertices = static_cast<std::uint32_t>(message.curve().xyz_size() / 3);
  require(message.curve().xyz_size() % 3 == 0 && message.curve().segments_size() % 2 == 0 &&
              message.curve().erosion_size() == message.curve().xyz_size() / 3 &&
              (vertices == 0 || all_between(message.curve().segments(), 0, vertices - 1)),
          "its curve");
  for (const auto* branches : {&message.parts(), &message.links()}) {
    for (const v1::SolidPart& branch : *branches) {
      require(branch.from_size() == 3 && branch.to_size() == 3, "a part without its ends");
      require(vertices > 0 && all_between(branch.vertices(), 0, vertices - 1), "a vertex out of range");
      require(!branch.has_angle_to() || (branch.angle_to() >= 1 && branch.angle_to() <= parts),
              "a part out of range");
    }
  }
  return message;
}

core::Mesh surface_of(const v1::SolidParts& parts) {
  const v1::TriangleMesh& surface = parts.surface();
  core::Mesh mesh;
  for (int v = 0; v < surface.xyz_size(); v += 3)
    mesh.points.push_back({surface.xyz(v), surface.xyz(v + 1), surface.xyz(v + 2)});
  for (int t = 0; t < surface.corners_size(); t += 3)
    mesh.triangles.push_back({surface.corners(t), surface.corners(t + 1), surface.corners(t + 2)});
  return mesh;
}

ThicknessScale thickness_scale(const core::Mesh& surface, std::span<const double> thickness) {
  constexpr double kRest = 0.01, kMore = 4.0 / 3;
  std::vector<std::pair<double, double>> thickest;  // with the area
  double rest = 0;
  for (std::size_t t = 0; t < thickness.size(); ++t) {
    const double area = core::norm(core::twice_area(surface, surface.triangles[t]));
    thickest.emplace_back(thickness[t], area);
    rest += kRest * area;
  }
  if (thickest.empty()) return {};
  std::sort(thickest.begin(), thickest.end(), std::greater<>());
  std::size_t first = 0;  // of those that are not left out
  while (rest > 0 && first + 1 < thickest.size() && thickest[first].second <= rest)
    rest -= thickest[first++].second;
  const double greatest = thickest.front().first, most = thickest[first].first;
  return {greatest > kMore * most && most > 0 ? most : greatest, greatest};
}

std::vector<Rgb> colours_of(const v1::SolidParts& parts) {
  return part_colours(surface_of(parts).triangles,
                      {parts.triangle_part().data(), std::size_t(parts.triangle_part_size())},
                      static_cast<std::uint32_t>(parts.parts_size()));
}

}  // namespace affskel::client
