#include "derive/derive.h"

#include "derive/chord_skeleton.h"
#include "derive/curve_skeleton.h"
#include "derive/eroded_solid.h"
#include "derive/operator_skeleton.h"
#include "derive/ridge_skeleton.h"
#include "derive/solid_parts.h"
#include "job/result_bytes.h"

namespace affskel::worker {
namespace {

v1::SkeletonPoints skeleton(const FinishedField& field, const v1::SkeletonParams& params) {
  switch (params.operator_()) {
    case v1::OPERATOR_CHORDS:
      return chord_skeleton(field, params);
    case v1::OPERATOR_RIDGE:
      return ridge_skeleton(field, params);
    case v1::OPERATOR_CURVE:
      return curve_skeleton(field, params);
    default:
      return operator_skeleton(field, params);
  }
}

v1::TriangleMesh surface(const FinishedField& field, const v1::SurfaceParams& params) {
  switch (params.skeleton().operator_()) {
    case v1::OPERATOR_CHORDS:
      return chord_sheet(field, params);
    case v1::OPERATOR_RIDGE:
      return ridge_sheet(field, params);
    case v1::OPERATOR_CURVE:
      return curve_lines(field, params);
    default:
      return operator_surface(field, params);
  }
}

// What others derive may take as much memory as what is known.
bool looks_at_ridges(const v1::Lease& lease) {
  const v1::Operator which = lease.kind() == v1::TASK_KIND_SURFACE ? lease.surface().skeleton().operator_()
                                                                   : lease.skeleton().operator_();
  return lease.kind() == v1::TASK_KIND_PARTS || which == v1::OPERATOR_RIDGE || which == v1::OPERATOR_CURVE;
}

Derived packed(const v1::SkeletonPoints& points, const std::string& what) {
  Derived result;
  append_result(result.data, points, what);
  result.items = static_cast<std::uint64_t>(points.point_size());
  if (points.has_quality()) result.quality = points.quality();
  return result;
}

Derived packed(const v1::TriangleMesh& mesh, const std::string& what) {
  Derived result;
  append_result(result.data, mesh, what);
  result.items = static_cast<std::uint64_t>(mesh.xyz_size() / 3);
  if (mesh.has_quality()) result.quality = mesh.quality();
  return result;
}

Derived packed(const v1::SolidParts& parts) {
  Derived result;
  append_result(result.data, parts, "the parts of the solid (a wider spacing has fewer points)");
  result.items = static_cast<std::uint64_t>(parts.parts_size());
  return result;
}

}  // namespace

Derived derive(const v1::Lease& lease, const PreparedJob& job, std::string_view stored,
               core::ExecutionContext* context, unsigned threads, KnownRidges* known) {
  if (known != nullptr && !looks_at_ridges(lease)) *known = {};
  if (known != nullptr) known->look_at(lease.job().id(), lease.field());
  const bool refined = lease.job().params().minimum() == v1::MINIMUM_INFIMUM;
  const FinishedField field(job, refined ? refined_field(job, stored) : set_field(job, stored), context,
                            threads, known);
  field.throw_if_stopped();
  switch (lease.kind()) {
    case v1::TASK_KIND_SKELETON:
      return packed(skeleton(field, lease.skeleton()),
                    "the skeleton (a higher threshold keeps fewer points)");
    case v1::TASK_KIND_SURFACE:
      return packed(surface(field, lease.surface()), "the surface (a higher threshold keeps fewer points)");
    case v1::TASK_KIND_DIVERGENCE:
      return {operator_divergence(field, lease.skeleton().operator_()), job.lattice().points, std::nullopt};
    case v1::TASK_KIND_ERODED_POINTS:
      return packed(eroded_points(field, lease.eroded()),
                    "the eroded solid (a higher level has fewer points)");
    case v1::TASK_KIND_ERODED_SURFACE:
      return packed(eroded_surface(field, lease.eroded()), "the eroded solid (a higher level is smaller)");
    case v1::TASK_KIND_PARTS:
      return packed(solid_parts(field, lease.skeleton()));
    default:
      throw std::logic_error("not a derive task");
  }
}

}  // namespace affskel::worker
