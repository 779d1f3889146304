#include "derive/chord_skeleton.h"
#include "core/error.h"
namespace affskel::worker {
v1::SkeletonPoints chord_skeleton(const FinishedField&, const v1::SkeletonParams&) {
  throw core::CoreError(core::CoreError::Code::kInternal, "later");
}
v1::TriangleMesh chord_sheet(const FinishedField&, const v1::SkeletonParams&) {
  throw core::CoreError(core::CoreError::Code::kInternal, "later");
}
}  // namespace affskel::worker
