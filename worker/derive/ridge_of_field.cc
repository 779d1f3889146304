#include "derive/ridge_of_field.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/quality/skeleton_advice.h"
#include "derive/messages.h"

namespace affskel::worker {
namespace {

struct Places {
  std::vector<core::Vec3> places;     // in the frame
  std::vector<std::uint32_t> points;  // the sample point of each
};

Places where(const core::SheetMesh& skeleton) {
  Places result;
  for (const core::SheetVertex& vertex : skeleton.vertices) {
    result.places.push_back(vertex.position);
    result.points.push_back(vertex.point);
  }
  return result;
}

}  // namespace

RidgeOfField::RidgeOfField(const FinishedField& field) : field_(field) {
  auto& basis = field.known().basis;
  if (!basis)
    basis = core::ridge_basis(field.job().solid(), field.lattice(), field.in_frame(), field.threads(),
                              field.context());
}

void RidgeOfField::find(std::initializer_list<double> thresholds) const {
  auto& sheets = field_.known().sheets;
  std::vector<core::RidgeBounds> unknown;
  for (const double threshold : thresholds)
    if (const core::RidgeBounds bounds = ridge_bounds(threshold); !sheets.contains(bounds.low))
      unknown.push_back(bounds);
  std::vector<core::RidgeSheet> found(unknown.size());
  core::parallel_for(field_.threads(), unknown.size(), [&](std::size_t n) {
    const auto threads = std::max(1U, field_.threads() / static_cast<unsigned>(unknown.size()));
    found[n] = core::ridge_sheet(field_.job().solid(), field_.lattice(), field_.in_frame(), basis(),
                                 {.bounds = unknown[n], .threads = threads, .context = field_.context()});
  });
  for (std::size_t n = 0; n < found.size(); ++n) sheets.emplace(unknown[n].low, std::move(found[n]));
}

const core::RidgeSheet& RidgeOfField::sheet(double threshold) const {
  find({threshold});
  return field_.known().sheets.at(ridge_bounds(threshold).low);
}

void RidgeOfField::report_lattice(const core::RidgeSheet& sheet, v1::SkeletonQuality& message,
                                  bool cut) const {
  v1::LatticeTopology& lattice = *message.mutable_lattice();
  lattice.set_components(sheet.lattice.components);
  lattice.set_holes(sheet.lattice.holes);
  lattice.set_cavities(sheet.lattice.cavities);
  message.set_fragments(sheet.fragments);
  message.set_unreached_ends(static_cast<std::uint32_t>(sheet.unreached.size()));
  for (std::size_t n = 0; n < std::min(kMaxPlaces, sheet.unreached.size()); ++n)
    set_place(sheet.unreached[n].place, sheet.unreached[n].distance, *message.add_unreached());
  const auto solid = static_cast<std::uint64_t>(message.solid_genus());
  const std::uint64_t more = sheet.lattice.holes - std::min(sheet.lattice.holes, solid);
  for (std::size_t n = 0; n < std::min<std::size_t>(more, basis().loops.size()); ++n)
    set_place(field_.to_mesh(basis().loops[n].place), basis().loops[n].size * field_.lattice().spacing,
              *message.add_tunnels());
  if (!message.advice().empty()) return;
  core::BettiNumbers kept = sheet.lattice;
  kept.components -= sheet.fragments;
  const core::BettiNumbers of_solid{message.solid_components(), solid, message.solid_cavities()};
  const bool meet = kept != of_solid && field_.job().solid().surfaces_meet;
  add_advice(core::coarse_lattice_advice(field_.lattice(), kept, of_solid, meet), message);
  if (!message.advice().empty() || cut) return;
  const std::size_t vertices = sheet.vertices.size() / std::max<std::size_t>(1, kept.components);
  add_advice(core::small_skeleton_advice(field_.lattice(), basis().radius, vertices), message);
  if (!message.advice().empty()) return;
  const auto [places, points] = where(sheet);
  add_advice(core::bare_solid_advice(field_.lattice(), basis().radius, places, points), message);
}

core::Advice RidgeOfField::flat_advice(const core::SheetMesh& lines) const {
  const auto [places, points] = where(lines);
  return core::flat_solid_advice(field_.lattice(), basis().radius, places, points);
}

void RidgeOfField::report_ridge(const core::RidgeSheet& sheet, double threshold,
                                v1::SkeletonQuality& message) {
  if (!message.advice().empty() || sheet.vertices.empty()) return;
  const auto on_ridge =
      std::count_if(sheet.vertices.begin(), sheet.vertices.end(), [](const core::SheetVertex& vertex) {
        return vertex.kind == core::SkeletonKind::kRidge || vertex.kind == core::SkeletonKind::kCurve;
      });
  const double share = static_cast<double>(on_ridge) / static_cast<double>(sheet.vertices.size());
  add_advice(core::little_ridge_advice(share, threshold, sheet.strongest), message);
}

void RidgeOfField::append_points(const core::SheetMesh& skeleton, v1::SkeletonPoints& message) const {
  for (const core::SheetVertex& vertex : skeleton.vertices) {
    message.add_point(vertex.point);
    append(field_.to_mesh(vertex.position), message.mutable_xyz());
    message.add_erosion(vertex.erosion);
    append(field_.normal(vertex.point), message.mutable_normal());
    if (field_.over_set()) message.add_direction(field_.optimal()[vertex.point]);
    message.add_divergence(vertex.strength);
  }
}

void append_vertices(const FinishedField& field, const core::SheetMesh& skeleton, v1::TriangleMesh& message) {
  for (const core::SheetVertex& vertex : skeleton.vertices) {
    append(field.to_mesh(vertex.position), message.mutable_xyz());
    message.add_erosion(vertex.erosion);
    message.add_strength(vertex.strength);
    message.add_ratio(vertex.ratio);
    message.add_kind(static_cast<std::uint32_t>(vertex.kind));
    message.add_area(vertex.area);
    append(field.normal_to_mesh(vertex.normal_a), message.mutable_normal_a());
    append(field.normal_to_mesh(vertex.normal_b), message.mutable_normal_b());
  }
}

void append_segments(const core::SheetMesh& skeleton, v1::TriangleMesh& message) {
  for (const core::Segment& segment : skeleton.segments) {
    for (const std::uint32_t end : segment) message.add_segments(end);
  }
}

core::RidgeBounds ridge_bounds(double threshold) {
  core::RidgeBounds bounds;
  if (threshold != 0) {
    // The two keep their ratio.
    bounds.high *= threshold / bounds.low;
    bounds.low = threshold;
  }
  return bounds;
}

}  // namespace affskel::worker
