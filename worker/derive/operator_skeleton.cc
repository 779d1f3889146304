#include "derive/operator_skeleton.h"

#include <optional>

#include "base/coding.h"
#include "core/base/error.h"
#include "core/erosion/field_between.h"
#include "core/quality/skeleton_quality.h"
#include "core/shocks/shock_operator.h"
#include "core/shocks/skeleton.h"
#include "core/surface/alpha_shape.h"
#include "derive/messages.h"
#include "job/result_bytes.h"
#include "wire/words.h"

namespace affskel::worker {
namespace {

core::ShockOperator core_operator(v1::Operator which) {
  if (which == v1::OPERATOR_UNSPECIFIED) return core::ShockOperator::kZuckerHummel;
  const std::optional<core::ShockOperator> found = core::shock_operator_named(wire::word(which));
  if (found) return *found;
  core::refuse("this worker does not know the skeleton operator; update the worker");
}

std::vector<double> divergence_of(const FinishedField& field, core::ShockOperator which) {
  std::vector<double> values =
      core::divergence(which, field.lattice(), field.frame_directions(), field.optimal(), field.context());
  field.throw_if_stopped();
  return values;
}

double threshold_of(const FinishedField& field, const v1::SkeletonParams& params) {
  if (params.threshold() != 0) return params.threshold();
  return core::default_threshold(core_operator(params.operator_()), field.lattice().spacing);
}

std::vector<core::LatticePlace> places_of(const FinishedField& field,
                                          const std::vector<core::SkeletonPoint>& points) {
  std::vector<std::uint32_t> ranks;
  ranks.reserve(points.size());
  for (const core::SkeletonPoint& kept : points) ranks.push_back(kept.point);
  return core::lattice_places(field.lattice(), ranks);
}

}  // namespace

v1::SkeletonPoints operator_skeleton(const FinishedField& field, const v1::SkeletonParams& params) {
  const core::ShockOperator which = core_operator(params.operator_());
  const double threshold = threshold_of(field, params);
  const std::vector<double> divergence = divergence_of(field, which);
  const std::vector<core::SkeletonPoint> kept = core::skeleton_points(divergence, threshold);
  const std::vector<core::LatticePlace> places = places_of(field, kept);
  v1::SkeletonPoints message;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    append_point(field, kept[i].point, places[i], message);
    message.add_divergence(kept[i].divergence);
  }
  field.throw_if_stopped();
  *message.mutable_quality() =
      quality_message(core::skeleton_quality(field.job().solid(), field.lattice(), field.optimal(),
                                             divergence, {which, threshold, field.more_directions()}));
  message.mutable_quality()->set_threshold(threshold);
  return message;
}

v1::TriangleMesh operator_surface(const FinishedField& field, const v1::SurfaceParams& params) {
  const std::vector<core::SkeletonPoint> kept =
      core::skeleton_points(divergence_of(field, core_operator(params.skeleton().operator_())),
                            threshold_of(field, params.skeleton()));
  std::vector<core::Vec3> points;
  for (const core::LatticePlace& place : places_of(field, kept)) points.push_back(field.in_frame(place));
  field.throw_if_stopped();
  core::AlphaShapeOptions options;
  options.alpha = params.alpha();
  options.spacing = field.lattice().spacing;
  options.context = field.context();
  core::Mesh surface = core::alpha_shape(points, options);
  v1::TriangleMesh message;
  for (core::Vec3& p : surface.points) {
    append(field.to_mesh(p), message.mutable_xyz());
    p = (1 / options.spacing) * p;
  }
  append_corners(surface, message);
  append_values(core::field_between(field.lattice(), field.in_frame(), surface.points), message);
  return message;
}

std::string operator_divergence(const FinishedField& field, v1::Operator which) {
  if (field.lattice().points > wire::kMaxResultBytes / sizeof(double)) {
    throw core::CoreError(core::CoreError::Code::kLimit,
                          "the divergence of " + std::to_string(field.lattice().points) +
                              " points is larger than what can be sent; take a wider spacing");
  }
  const std::vector<double> values = divergence_of(field, core_operator(which));
  std::string bytes(values.size() * sizeof(double), '\0');
  for (std::size_t p = 0; p < values.size(); ++p) base::encode(bytes.data() + p * sizeof(double), values[p]);
  return bytes;
}

}  // namespace affskel::worker
