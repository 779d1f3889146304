#include "derive/chord_skeleton.h"

#include <optional>

#include "core/chords/chord_sheet.h"
#include "core/infimum/piece_input.h"
#include "core/quality/skeleton_advice.h"
#include "core/quality/skeleton_quality.h"
#include "core/ridge/local_depth.h"
#include "core/shocks/shock_operator.h"
#include "derive/messages.h"
#include "derive/sheet_barriers.h"

namespace affskel::worker {
namespace {

double significance_of(double threshold) {
  return threshold != 0 ? threshold : core::ChordSheetOptions().significance;
}

// Makes the sheets of one field.
class Sheets {
 public:
  explicit Sheets(const FinishedField& field) : field_(field) {
    if (field.over_set()) return;
    input_.emplace(field.job().solid(), field.threads());
    refined_.emplace(core::RefinedPieces{*input_, field.saddles(), field.threads()});
  }

  core::ChordSheet at(double significance) const {
    core::ChordSheetOptions options;
    options.context = field_.context();
    options.refined = refined_ ? &*refined_ : nullptr;
    options.significance = significance;
    return core::chord_sheet(field_.job().solid(), field_.lattice(), field_.in_frame(), options);
  }

 private:
  const FinishedField& field_;
  std::optional<core::PieceInput> input_;
  std::optional<core::RefinedPieces> refined_;
};

void report_stray(const FinishedField& field, const core::ChordSheet& sheet, v1::SkeletonQuality& message) {
  std::vector<core::Vec3> places;
  std::vector<std::uint32_t> points;
  for (const core::ChordShock& shock : sheet.shocks) {
    places.push_back(shock.position);
    points.push_back(shock.point);
  }
  if (places.empty()) return;
  const std::vector<float> radius = core::surface_distance(field.lattice());
  add_advice(
      core::stray_sheet_advice(field.lattice(), radius, places, points,
                               {message.components(), message.holes(), message.cavities()},
                               {message.solid_components(), static_cast<std::uint64_t>(message.solid_genus()),
                                message.solid_cavities()}),
      message);
}

// @param points the shocks, when they are the skeleton's points; null: the sheet's vertices are.
v1::SkeletonQuality chord_quality_of(const FinishedField& field, const Sheets& sheets,
                                     const core::ChordSheet& sheet, double significance,
                                     const std::vector<core::Vec3>* points,
                                     const SheetBarriers& barriers = {}) {
  const double next = core::next_threshold(significance);
  core::SheetQualityOptions options;
  options.advice_if_empty = core::empty_sheet_advice(field.lattice(), sheet.census, significance,
                                                     sheet.strong_turn, field.more_directions());
  if (!barriers.advice.text.empty()) options.advice_if_empty = barriers.advice;
  options.points = points;
  core::Mesh other;
  if (next < 1 && !barriers.cut) {
    other = mesh_of(sheets.at(next));
    options.other = &other;
    options.other_threshold = next;
  }
  field.throw_if_stopped();
  v1::SkeletonQuality message =
      quality_message(core::sheet_quality(field.job().solid(), field.lattice(), mesh_of(sheet), options));
  message.set_threshold(significance);
  if (!sheet.shocks.empty()) message.set_bridges(sheet.bridges);
  if (!barriers.cut) report_stray(field, sheet, message);
  return message;
}

}  // namespace

v1::SkeletonPoints chord_skeleton(const FinishedField& field, const v1::SkeletonParams& params) {
  const double significance = significance_of(params.threshold());
  const Sheets sheets(field);
  const core::ChordSheet sheet = sheets.at(significance);
  v1::SkeletonPoints message;
  std::vector<core::Vec3> points;
  for (const core::ChordShock& shock : sheet.shocks) {
    points.push_back(shock.position);
    message.add_point(shock.point);
    append(field.to_mesh(shock.position), message.mutable_xyz());
    message.add_erosion(shock.erosion);
    append(field.normal(shock.point), message.mutable_normal());
    if (field.over_set()) message.add_direction(shock.direction_low);
    message.add_divergence(shock.strength);
  }
  *message.mutable_quality() = chord_quality_of(field, sheets, sheet, significance, &points);
  return message;
}

v1::TriangleMesh chord_sheet(const FinishedField& field, const v1::SurfaceParams& params) {
  const double significance = significance_of(params.skeleton().threshold());
  const Sheets sheets(field);
  core::ChordSheet sheet = sheets.at(significance);
  std::vector<core::Segment> none;
  const SheetBarriers barriers = take_barriers(field, params, sheet, none);
  v1::TriangleMesh message;
  for (const core::SheetVertex& vertex : sheet.vertices) {
    append(field.to_mesh(vertex.position), message.mutable_xyz());
    message.add_erosion(vertex.erosion);
    message.add_strength(vertex.strength);
    message.add_area(vertex.area);
    append(field.normal_to_mesh(vertex.normal_a), message.mutable_normal_a());
    append(field.normal_to_mesh(vertex.normal_b), message.mutable_normal_b());
  }
  message.mutable_barrier()->Add(barriers.barrier.begin(), barriers.barrier.end());
  append_corners(mesh_of(sheet), message);
  *message.mutable_quality() = chord_quality_of(field, sheets, sheet, significance, nullptr, barriers);
  return message;
}

}  // namespace affskel::worker
