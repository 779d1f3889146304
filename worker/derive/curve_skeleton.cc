#include "derive/curve_skeleton.h"

#include "base/number_text.h"
#include "base/ridge_threshold.h"
#include "core/curve/curve_skeleton.h"
#include "core/quality/skeleton_quality.h"
#include "core/shocks/shock_operator.h"
#include "derive/messages.h"
#include "derive/ridge_of_field.h"

namespace affskel::worker {
namespace {

// Of a field, at any threshold.
class Curves {
 public:
  explicit Curves(const FinishedField& field) : field_(field), ridge_(field), sheet_(ridge_.sheet(0)) {}

  const RidgeOfField& ridge() const { return ridge_; }

  core::CurveSkeleton at(double threshold) const {
    core::CurveOptions options;
    options.least_reach = threshold;
    options.context = field_.context();
    return core::curve_skeleton(field_.job().solid(), field_.lattice(), ridge_.basis(), sheet_, options);
  }

  v1::SkeletonQuality quality_of(const core::CurveSkeleton& curve, double threshold) const {
    core::SheetQualityOptions options;
    options.segments = curve.segments;
    const double next = core::next_threshold(threshold);
    core::Mesh other;
    if (next <= base::kMaxCurveThreshold) {
      other = mesh_of(at(next));
      options.other = &other;
      options.other_threshold = next;
    }
    field_.throw_if_stopped();
    v1::SkeletonQuality message =
        quality_message(core::sheet_quality(field_.job().solid(), field_.lattice(), mesh_of(curve), options));
    message.set_threshold(threshold);
    ridge_.tell_of_lattice(sheet_, message);
    message.set_branches(curve.branches);
    message.set_ends(curve.ends);
    message.set_opened(curve.opened);
    if (curve.segments.empty())
      set_advice(
          {"no limb is " + base::to_text(threshold) +
               " of its own radii long: the curve is the place of the greatest E alone, without a line.",
           {}},
          message);
    return message;
  }

 private:
  const FinishedField& field_;
  const RidgeOfField ridge_;
  const core::RidgeSheet sheet_;
};

double threshold_of(const v1::SkeletonParams& params) {
  return params.threshold() == 0 ? base::kMinCurveThreshold : params.threshold();
}

}  // namespace

v1::SkeletonPoints curve_skeleton(const FinishedField& field, const v1::SkeletonParams& params) {
  const Curves curves(field);
  const core::CurveSkeleton curve = curves.at(threshold_of(params));
  v1::SkeletonPoints message;
  curves.ridge().append_points(curve, message);
  *message.mutable_quality() = curves.quality_of(curve, threshold_of(params));
  return message;
}

v1::TriangleMesh curve_lines(const FinishedField& field, const v1::SurfaceParams& params) {
  const double threshold = threshold_of(params.skeleton());
  const Curves curves(field);
  const core::CurveSkeleton curve = curves.at(threshold);
  v1::TriangleMesh message;
  append_vertices(field, curve, message);
  message.mutable_distance()->Add(curve.distance.begin(), curve.distance.end());
  message.mutable_share()->Add(curve.share.begin(), curve.share.end());
  message.mutable_beyond()->Add(curve.beyond.begin(), curve.beyond.end());
  append_segments(curve, message);
  *message.mutable_quality() = curves.quality_of(curve, threshold);
  return message;
}

}  // namespace affskel::worker
