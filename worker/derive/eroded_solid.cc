#include "derive/eroded_solid.h"

#include <algorithm>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/surface/eroded_solid.h"
#include "derive/messages.h"
#include "wire/params.h"

namespace affskel::worker {
namespace {

// E of the level, mesh units cubed; a volume is below v0, as a fraction is below 1.
double level_of(const FinishedField& field, const v1::ErodedParams& params) {
  const v1::ErodedParams full = wire::canonical(params);
  const double v0 = field.job().solid().volume;
  if (full.level_case() != v1::ErodedParams::kVolume) return full.fraction() * v0;
  if (full.volume() < v0) return full.volume();
  core::refuse("the level of an eroded solid is below the solid's volume v0, " + base::rounded(v0, 4) +
               ", not " + base::rounded(full.volume(), 4));
}

// Why an eroded solid is empty.
core::Advice advice_for(const FinishedField& field, double level) {
  double largest = 0;
  for (std::size_t p = 0; p < field.optimal().size(); ++p)
    if (field.optimal()[p] != core::FieldValue::kNoDirection)
      largest = std::max(largest, field.in_frame().erosion[p]);
  const double v0 = field.job().solid().volume;
  const auto told = [&](double erosion) {
    return base::rounded(erosion, 4) + " (" + base::rounded(100 * erosion / v0, 4) + " % of v0)";
  };
  return {"no sample point reaches the level " + told(level) + "; the largest E is " + told(largest), {}};
}

}  // namespace

v1::SkeletonPoints eroded_points(const FinishedField& field, const v1::ErodedParams& params) {
  const std::vector<std::uint32_t> points = core::eroded_points(field.in_frame(), level_of(field, params));
  const std::vector<core::LatticePlace> places = core::lattice_places(field.lattice(), points);
  v1::SkeletonPoints message;
  for (std::size_t i = 0; i < points.size(); ++i) append_point(field, points[i], places[i], message);
  if (points.empty()) add_advice(advice_for(field, level_of(field, params)), *message.mutable_quality());
  return message;
}

v1::TriangleMesh eroded_surface(const FinishedField& field, const v1::ErodedParams& params) {
  core::ErodedSurfaceOptions options;
  options.level = level_of(field, params);
  options.context = field.context();
  const core::ErodedSurface surface =
      core::eroded_surface(field.job().solid(), field.lattice(), field.in_frame(), options);
  v1::TriangleMesh message;
  for (const core::Vec3& p : surface.mesh.points) append(p, message.mutable_xyz());
  append_corners(surface.mesh, message);
  append_values(surface.values, message);
  message.set_volume(surface.volume);
  if (surface.mesh.triangles.empty())
    add_advice(advice_for(field, options.level), *message.mutable_quality());
  return message;
}

}  // namespace affskel::worker
