#include "client/artifacts/surface.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "client/base/error.h"

namespace affskel::client {
namespace {

[[noreturn]] void damaged(const std::string& what) {
  throw ClientError(ExitCode::kInternal, "the server sent a damaged surface: " + what);
}

// Values of a vertex stand together in the message: a column takes every n-th of them.
template <class Value>
void add_columns(ShapeFile& shape, const std::vector<std::string>& names,
                 const google::protobuf::RepeatedField<Value>& values) {
  if (values.empty()) return;
  const std::size_t n = names.size(), vertices = shape.mesh().points.size();
  if (static_cast<std::size_t>(values.size()) != n * vertices) damaged("a vertex without its properties");
  for (std::size_t c = 0; c < n; ++c) {
    PointColumn column{names[c], std::is_integral_v<Value>, std::vector<double>(vertices)};
    for (std::size_t v = 0; v < vertices; ++v) column.values[v] = values[static_cast<int>(n * v + c)];
    shape.columns.push_back(std::move(column));
  }
}

// Of the circle with the area of the section: what a curve is the axis of.
void add_radius(ShapeFile& shape) {
  const PointColumn* area = shape.column("area");
  if (area == nullptr) damaged("a curve without its sections");
  PointColumn radius{"radius", false, area->values};
  for (double& value : radius.values) value = std::sqrt(value / std::numbers::pi);
  shape.columns.push_back(std::move(radius));
}

}  // namespace

FetchedSurface parse_surface(const std::string& bytes) {
  v1::TriangleMesh message;
  if (!message.ParseFromString(bytes) || message.xyz_size() % 3 != 0 || message.corners_size() % 3 != 0 ||
      message.segments_size() % 2 != 0) {
    damaged("odd numbers");
  }
  FetchedSurface surface;
  for (int i = 0; i < message.xyz_size(); i += 3) {
    surface.shape.off.mesh.points.push_back({message.xyz(i), message.xyz(i + 1), message.xyz(i + 2)});
  }
  for (int i = 0; i < message.corners_size(); i += 3) {
    const core::Triangle t = {message.corners(i), message.corners(i + 1), message.corners(i + 2)};
    for (const std::uint32_t corner : t) {
      if (corner >= surface.shape.off.mesh.points.size()) damaged("a corner out of range");
    }
    surface.shape.off.mesh.triangles.push_back(t);
  }
  for (int i = 0; i < message.segments_size(); i += 2) {
    const core::Segment segment = {message.segments(i), message.segments(i + 1)};
    for (const std::uint32_t end : segment) {
      if (end >= surface.shape.off.mesh.points.size()) damaged("an end of a segment out of range");
    }
    surface.shape.segments.push_back(segment);
  }
  add_columns(surface.shape, {"E"}, message.erosion());
  add_columns(surface.shape, {"strength"}, message.strength());
  add_columns(surface.shape, {"ratio"}, message.ratio());
  add_columns(surface.shape, {"kind"}, message.kind());
  add_columns(surface.shape, {"barrier"}, message.barrier());
  add_columns(surface.shape, {"area"}, message.area());
  add_columns(surface.shape, {"distance"}, message.distance());
  add_columns(surface.shape, {"share"}, message.share());
  add_columns(surface.shape, {"beyond"}, message.beyond());
  if (!message.radius().empty()) {
    add_columns(surface.shape, {"radius"}, message.radius());
  } else if (!surface.shape.segments.empty() || !message.distance().empty()) {
    add_radius(surface.shape);
  }
  add_columns(surface.shape, {"nx_a", "ny_a", "nz_a"}, message.normal_a());
  add_columns(surface.shape, {"nx_b", "ny_b", "nz_b"}, message.normal_b());
  add_columns(surface.shape, {"part"}, message.part());
  surface.quality = message.quality();
  surface.volume = message.volume();
  return surface;
}

}  // namespace affskel::client
