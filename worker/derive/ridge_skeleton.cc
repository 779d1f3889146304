#include "derive/ridge_skeleton.h"

#include <cstdint>
#include <optional>
#include <vector>

#include "core/quality/skeleton_quality.h"
#include "core/ridge/ridge_sheet.h"
#include "core/shocks/shock_operator.h"
#include "derive/curve_of_field.h"
#include "derive/messages.h"
#include "derive/ridge_of_field.h"
#include "derive/sheet_barriers.h"

namespace affskel::worker {
namespace {

constexpr double kMaxThreshold = 800;  // the contract's, see SkeletonParams

// What the report compares a sheet to, where there is any.
std::optional<double> next_of(double threshold) {
  const double next = core::next_threshold(ridge_bounds(threshold).low);
  return next <= kMaxThreshold ? std::optional(next) : std::nullopt;
}

// A sheet, and that which its report compares it to.
void find(const RidgeOfField& ridge, double threshold) {
  if (const auto next = next_of(threshold)) ridge.find({threshold, *next});
}

core::RidgeSheet drawn_out(const RidgeOfField& ridge, double threshold) {
  core::RidgeSheet sheet = ridge.sheet(threshold);
  core::draw_out(sheet);
  return sheet;
}

v1::SkeletonQuality quality_of(const FinishedField& field, const RidgeOfField& ridge,
                               const core::RidgeSheet& sheet, double threshold,
                               const SheetBarriers& barriers = {}) {
  const double low = ridge_bounds(threshold).low;
  core::SheetQualityOptions options;
  options.segments = sheet.segments;
  options.advice_if_empty = barriers.advice;
  core::Mesh other;
  if (const auto next = next_of(threshold); next && !barriers.cut) {
    other = mesh_of(drawn_out(ridge, *next));
    options.other = &other;
    options.other_threshold = *next;
  }
  field.throw_if_stopped();
  v1::SkeletonQuality message =
      quality_message(core::sheet_quality(field.job().solid(), field.lattice(), mesh_of(sheet), options));
  message.set_threshold(low);
  ridge.report_lattice(sheet, message, barriers.cut);
  if (!barriers.cut) RidgeOfField::report_ridge(sheet, low, message);
  message.set_limbs(sheet.limbs);
  return message;
}

// Of the sample points, by the default curve at every threshold.
std::vector<std::uint32_t> parts_of(const FinishedField& field, const RidgeOfField& ridge) {
  const CurveOfField curves(field, ridge);
  const core::CurveSkeleton& curve = curves.at(0);
  return parts_of_points(curve, curves.graph_of(curve));
}

}  // namespace

v1::SkeletonPoints ridge_skeleton(const FinishedField& field, const v1::SkeletonParams& params) {
  const RidgeOfField ridge(field);
  find(ridge, params.threshold());
  const core::RidgeSheet sheet = drawn_out(ridge, params.threshold());
  v1::SkeletonPoints message;
  ridge.append_points(sheet, message);
  *message.mutable_quality() = quality_of(field, ridge, sheet, params.threshold());
  return message;
}

v1::TriangleMesh ridge_sheet(const FinishedField& field, const v1::SurfaceParams& params) {
  const double threshold = params.skeleton().threshold();
  const RidgeOfField ridge(field);
  if (params.min_barrier() == 0) find(ridge, threshold);
  core::RidgeSheet sheet = drawn_out(ridge, threshold);
  const std::vector<std::uint32_t> parts = parts_of(field, ridge);
  const SheetBarriers barriers = take_barriers(field, params, sheet, sheet.segments);
  v1::TriangleMesh message;
  append_vertices(field, sheet, message);
  message.mutable_barrier()->Add(barriers.barrier.begin(), barriers.barrier.end());
  append_corners(mesh_of(sheet), message);
  append_segments(sheet, message);
  for (const core::SheetVertex& vertex : sheet.vertices) message.add_part(parts[vertex.point]);
  *message.mutable_quality() = quality_of(field, ridge, sheet, threshold, barriers);
  return message;
}

}  // namespace affskel::worker
