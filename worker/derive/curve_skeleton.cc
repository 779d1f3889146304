#include "derive/curve_skeleton.h"

#include "derive/curve_of_field.h"
#include "derive/ridge_of_field.h"

namespace affskel::worker {

v1::SkeletonPoints curve_skeleton(const FinishedField& field, const v1::SkeletonParams& params) {
  const RidgeOfField ridge(field);
  const CurveOfField curves(field, ridge);
  const core::CurveSkeleton& curve = curves.for_report(params.threshold());
  v1::SkeletonPoints message;
  ridge.append_points(curve, message);
  *message.mutable_quality() = curves.quality_of(curve, params.threshold());
  return message;
}

v1::TriangleMesh curve_lines(const FinishedField& field, const v1::SurfaceParams& params) {
  const double threshold = params.skeleton().threshold();
  const RidgeOfField ridge(field);
  const CurveOfField curves(field, ridge);
  return curves.message_of(curves.for_report(threshold), threshold);
}

}  // namespace affskel::worker
