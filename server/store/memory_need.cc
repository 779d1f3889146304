#include "store/memory_need.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "wire/memory_sizes.h"

namespace affskel::server {
namespace {

// A triangle is 50 bytes of OFF text when its numbers are long: itself, and what it becomes.
constexpr std::uint64_t kPerMeshByte = 1 + wire::kBytesPerTriangle / 50;

constexpr std::uint64_t kSmall = std::uint64_t{64} << 20;
constexpr int kStepsLog = 3;  // eight steps to a power of two

v1::Operator shocks_of(v1::TaskKind kind, const std::string& params) {
  v1::SkeletonParams skeleton;
  v1::SurfaceParams surface;
  if (kind == v1::TASK_KIND_SKELETON && skeleton.ParseFromString(params)) return skeleton.operator_();
  if (kind == v1::TASK_KIND_SURFACE && surface.ParseFromString(params)) return surface.skeleton().operator_();
  return kind == v1::TASK_KIND_PARTS ? v1::OPERATOR_CURVE : v1::OPERATOR_UNSPECIFIED;
}

}  // namespace

std::uint64_t memory_need(v1::TaskKind kind, std::uint64_t mesh_bytes, const v1::ErosionParams& params,
                          const v1::PreparedSummary& prepared, v1::Operator shocks) {
  if (kind == v1::TASK_KIND_PREPARE && prepared.triangles() == 0) {
    return mesh_bytes * kPerMeshByte + params.sampling().target_points() * wire::kBytesPerPoint;
  }
  const bool refine = kind == v1::TASK_KIND_REFINE;
  const std::uint64_t per_point = wire::kBytesPerPoint + wire::skeleton_bytes_per_point(shocks) +
                                  (refine ? wire::kRefineBytesPerPoint : 0);
  return prepared.triangles() * (wire::kBytesPerTriangle + (refine ? wire::kRefineBytesPerTriangle : 0)) +
         prepared.points() * per_point;
}

std::int64_t rounded_need(std::uint64_t bytes) {
  if (bytes < kSmall) return 0;
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / 2);
  const std::uint64_t step = std::uint64_t{1} << (std::bit_width(std::min(bytes, kMax)) - 1 - kStepsLog);
  return static_cast<std::int64_t>((std::min(bytes, kMax) + step - 1) / step * step);
}

std::int64_t memory_need_of(Database& db, const std::string& job_id, v1::TaskKind kind,
                            const std::string& params) {
  Statement row = db.query(
      "SELECT m.bytes, e.params, e.prepared FROM jobs j JOIN erosions e ON e.id = j.erosion_id"
      " JOIN meshes m ON m.sha256 = e.mesh_sha256 WHERE j.id = ?",
      job_id);
  if (!row.step()) return 0;
  Columns columns(row);
  const std::uint64_t mesh_bytes = columns.natural();
  v1::ErosionParams erosion;
  erosion.ParseFromString(std::string(columns.blob()));
  v1::PreparedSummary prepared;
  if (const auto bytes = columns.blob_or_null()) prepared.ParseFromString(std::string(*bytes));
  return rounded_need(memory_need(kind, mesh_bytes, erosion, prepared, shocks_of(kind, params)));
}

}  // namespace affskel::server
