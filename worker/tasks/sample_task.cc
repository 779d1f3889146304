#include "tasks/sample_task.h"

#include <cstdint>
#include <vector>

#include "core/erosion/erosion.h"
#include "wire/direction_order.h"
#include "wire/field_record.h"

namespace affskel::worker {

std::string sample_field(const v1::Lease& lease, const PreparedJob& job, core::ExecutionContext& context,
                         unsigned threads) {
  std::vector<std::uint32_t> directions;
  for (const v1::PositionRange& range : lease.positions()) {
    for (std::uint64_t position = range.begin(); position < range.end(); ++position) {
      directions.push_back(static_cast<std::uint32_t>(
          wire::direction_at(position, lease.job().order_stride(), job.directions().size())));
    }
  }
  core::ErosionOptions options;
  options.threads = threads;
  core::Erosion erosion(job.solid(), job.lattice(), job.directions(), options);
  erosion.run(directions, context);
  core::throw_if_stopped(&context);
  const std::uint32_t points = erosion.field().size();
  std::string bytes(points * wire::kFieldRecordBytes, '\0');
  for (std::uint32_t point = 0; point < points; ++point) {
    const core::FieldValue value = erosion.field().value(point);
    wire::encode_field_record(
        bytes.data() + point * wire::kFieldRecordBytes,
        value.direction == core::FieldValue::kNoDirection ? wire::FieldRecord() : job.record(value));
  }
  return bytes;
}

}  // namespace affskel::worker
