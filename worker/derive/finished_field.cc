#include "derive/finished_field.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/matrix3.h"
#include "wire/refined_record.h"

namespace affskel::worker {

FieldValues set_field(const PreparedJob& job, std::string_view stored) {
  return {true, unpack_field(stored, job.lattice().points), job.directions()};
}

FieldValues refined_field(const PreparedJob& job, std::string_view stored) {
  const std::uint32_t points = job.lattice().points;
  if (stored.size() != std::size_t{points} * wire::kRefinedRecordBytes) {
    throw core::CoreError(core::CoreError::Code::kInternal,
                          "the stored refined field has " + std::to_string(stored.size()) + " bytes for " +
                              std::to_string(points) + " points");
  }
  FieldValues field;
  field.over_set = false;
  field.saddles.reserve(points);
  field.values.reserve(points);
  field.directions.reserve(points);
  for (std::uint32_t p = 0; p < points; ++p) {
    const wire::RefinedRecord record =
        wire::decode_refined_record(stored.data() + std::size_t{p} * wire::kRefinedRecordBytes);
    field.values.push_back({record.erosion, record.slope, p});
    field.directions.push_back({record.normal[0], record.normal[1], record.normal[2]});
    field.saddles.push_back(record.saddles);
  }
  return field;
}

FinishedField::FinishedField(const PreparedJob& job, FieldValues field, core::ExecutionContext* context,
                             unsigned threads, KnownRidges* known)
    : job_(job),
      context_(context),
      threads_(threads),
      own_(known == nullptr ? std::make_unique<KnownRidges>() : nullptr),
      known_(known == nullptr ? own_.get() : known),
      over_set_(field.over_set),
      saddles_(std::move(field.saddles)),
      in_frame_(core::frame_field(job.lattice(), field.directions, field.values)),
      directions_(std::move(field.directions)),
      frame_directions_(core::frame_directions(job.lattice(), directions_)),
      places_(job.solid(), job.lattice()) {}

std::size_t FinishedField::more_directions() const {
  const std::size_t triangles = job_.solid().mesh.triangles.size();
  return job_.directions().size() - std::min(job_.directions().size(), triangles);
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
  const std::uint32_t direction = in_frame_.direction[point];
  return direction == core::FieldValue::kNoDirection ? core::Vec3{} : directions_[direction];
}

}  // namespace affskel::worker
