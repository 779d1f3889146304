#include "client/artifacts/skeleton_points.h"

#include "client/base/error.h"

namespace affskel::client {
namespace {

bool consistent(const v1::SkeletonPoints& s) {
  const int n = s.point_size();
  return s.xyz_size() == 3 * n && s.erosion_size() == n && s.normal_size() == 3 * n &&
         (s.direction_size() == n || s.direction_size() == 0);
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

ShapeFile shape_of(const v1::SkeletonPoints& s) {
  ShapeFile shape;
  shape.columns = {{"E", false, {s.erosion().begin(), s.erosion().end()}},
                   {"nx", false, {}},
                   {"ny", false, {}},
                   {"nz", false, {}}};
  if (!s.direction().empty() || s.point_size() == 0)
    shape.columns.push_back({"direction", true, {s.direction().begin(), s.direction().end()}});
  for (int p = 0; p < s.point_size(); ++p) {
    shape.off.mesh.points.push_back({s.xyz(3 * p), s.xyz(3 * p + 1), s.xyz(3 * p + 2)});
    for (int c = 0; c < 3; ++c) {
      shape.columns[static_cast<std::size_t>(1 + c)].values.push_back(s.normal(3 * p + c));
    }
  }
  if (!s.divergence().empty() || s.point_size() == 0) {
    shape.columns.push_back({"H", false, {s.divergence().begin(), s.divergence().end()}});
  }
  return shape;
}

}  // namespace affskel::client
