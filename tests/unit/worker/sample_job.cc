#include "sample_job.h"

#include <numeric>

#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "wire/direction_order.h"

namespace affskel::worker {
namespace {

constexpr const char* kJobId = "0123456789abcdef0123456789abcdef";

void append(std::string& bytes, const core::FieldValue& value, double volume_unit, double area_unit) {
  const double erosion = value.erosion * volume_unit, area = value.area * area_unit;
  bytes.append(reinterpret_cast<const char*>(&erosion), 8);
  bytes.append(reinterpret_cast<const char*>(&area), 8);
  bytes.append(reinterpret_cast<const char*>(&value.direction), 4);
}

}  // namespace

std::string sample_mesh() {
  return core::write_off(core::make_torus(6000, 2000, 256));
}

v1::ErosionParams sample_params() {
  v1::ErosionParams params;
  params.mutable_sampling()->set_spacing(500);
  params.set_repair(true);
  return params;
}

v1::Lease other_lease(const std::string& token, v1::TaskKind kind) {
  v1::Lease lease;
  lease.set_token(token);
  lease.set_kind(kind);
  lease.set_lease_ms(5000);
  lease.set_report_interval_ms(20);
  lease.mutable_job()->set_id(kJobId);
  *lease.mutable_job()->mutable_params() = sample_params();
  return lease;
}

v1::Lease derive_lease(const PreparedJob& prepared, const std::string& token, v1::TaskKind kind) {
  v1::Lease lease = other_lease(token, kind);
  *lease.mutable_job()->mutable_prepared() = prepared.summary();
  lease.mutable_job()->set_directions_total(prepared.directions().size());
  return lease;
}

v1::Lease erode_lease(const PreparedJob& prepared, const std::string& token, std::uint64_t begin,
                      std::uint64_t end) {
  v1::Lease lease = derive_lease(prepared, token, v1::TASK_KIND_ERODE);
  lease.mutable_job()->set_order_stride(wire::direction_stride(prepared.directions().size()));
  lease.mutable_job()->set_directions_done(1);  // as if others had begun
  v1::PositionRange* range = lease.add_positions();
  range->set_begin(begin);
  range->set_end(end);
  return lease;
}

std::string empty_field(const PreparedJob& prepared) {
  std::string bytes;
  for (std::uint32_t p = 0; p < prepared.lattice().points; ++p) append(bytes, {}, 1, 1);
  return bytes;
}

std::string finished_field(const PreparedJob& prepared) {
  core::Erosion erosion(prepared.solid(), prepared.lattice(), prepared.directions(), {});
  std::vector<std::uint32_t> list(prepared.directions().size());
  std::iota(list.begin(), list.end(), 0U);
  core::ExecutionContext context;
  erosion.run(list, context);
  std::string bytes;
  for (std::uint32_t p = 0; p < prepared.lattice().points; ++p) {
    append(bytes, erosion.field().value(p), prepared.volume_unit(), prepared.area_unit());
  }
  return bytes;
}

}  // namespace affskel::worker
