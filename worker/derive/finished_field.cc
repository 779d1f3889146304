#include "derive/finished_field.h"

#include "core/base/matrix3.h"

namespace affskel::worker {

FinishedField::FinishedField(const PreparedJob& job, std::string_view stored, core::ExecutionContext* context,
                             unsigned threads)
    : job_(job),
      context_(context),
      threads_(threads),
      values_(unpack_field(stored, job.lattice().points)),
      frame_directions_(core::frame_directions(job.lattice(), job.directions())),
      places_(job.solid(), job.lattice()) {}

core::OptimalDirections FinishedField::optimal() const {
  core::OptimalDirections list;
  list.reserve(values_.size());
  for (const core::FieldValue& value : values_) list.push_back(value.direction);
  return list;
}

core::FrameField FinishedField::in_frame() const {
  return core::frame_field(lattice(), job_.directions(), values_);
}

core::Vec3 FinishedField::to_mesh(const core::Vec3& frame_point) const {
  const double step = 1 / lattice().spacing;
  const auto& axes = places_.axes();
  return places_.origin() + ((step * frame_point.x) * axes[0] +
                             ((step * frame_point.y) * axes[1] + (step * frame_point.z) * axes[2]));
}

core::Vec3 FinishedField::normal_to_mesh(const core::Vec3& frame_normal) const {
  const core::Vec3 n = core::inverse_transposed(core::frame_matrix(lattice())) * frame_normal;
  const double length = core::norm(n);
  return length > 0 ? (1 / length) * n : n;
}

core::Vec3 FinishedField::in_frame(const core::LatticePlace& at) const {
  const double step = lattice().spacing;
  return {step * at[0], step * at[1], step * at[2]};
}

core::Vec3 FinishedField::normal(std::uint32_t point) const {
  const std::uint32_t direction = values_[point].direction;
  return direction == core::FieldValue::kNoDirection ? core::Vec3{} : job_.directions()[direction];
}

}  // namespace affskel::worker
