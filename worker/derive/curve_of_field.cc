#include "derive/curve_of_field.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "base/ridge_threshold.h"
#include "core/base/parallel.h"
#include "core/quality/skeleton_advice.h"
#include "core/quality/skeleton_quality.h"
#include "core/shocks/shock_operator.h"
#include "derive/messages.h"

namespace affskel::worker {
namespace {

double threshold_of(double given) {
  return given == 0 ? base::kMinCurveThreshold : given;
}

// That of the lines that a report compares a curve to, where there are any.
std::optional<double> compared_to(double threshold) {
  const double next = core::next_threshold(threshold_of(threshold));
  return next <= base::kMaxCurveThreshold ? std::optional(next) : std::nullopt;
}

// Why a curve has none.
std::string without_lines(const core::CurveSkeleton& curve, double threshold) {
  const std::string alone = "the curve is the place of the skeleton's greatest E alone, without a line.";
  if (curve.opened.empty())
    return "no limb is " + base::to_text(threshold) + " of its own radii long: " + alone;
  return "the solid is a membrane round a cavity, and a line leads through limbs, not round that: " + alone +
         " The operator ridge has its sheet.";
}

}  // namespace

core::CurveOptions CurveOfField::options_at(double threshold) const {
  core::CurveOptions options;
  options.least_reach = threshold_of(threshold);
  options.threads = field_.threads();
  options.context = field_.context();
  return options;
}

core::SheetMesh CurveOfField::lines_at(double threshold) const {
  if (auto known = lines_.extract(threshold)) return std::move(known.mapped());
  return core::curve_lines(input(), options_at(threshold));
}

core::CurveInput CurveOfField::input() const {
  const core::Solid& solid = field_.job().solid();
  if (!surface_)
    // No make_unique: it cannot be moved.
    surface_.reset(new core::LimbSurface(core::limb_surface(solid, field_.lattice(), field_.threads())));
  return {solid, field_.lattice(), ridge_.basis(), sheet_, *surface_};
}

const core::CurveSkeleton& CurveOfField::at(double threshold) const {
  const core::CurveOptions options = options_at(threshold);
  auto& curves = field_.known().curves;
  const auto known = curves.find(options.least_reach);
  if (known != curves.end()) return known->second;
  return curves.emplace(options.least_reach, core::curve_skeleton(input(), options)).first->second;
}

const core::CurveSkeleton& CurveOfField::for_report(double threshold) const {
  const auto next = compared_to(threshold);
  const core::CurveOptions options = options_at(threshold);
  auto& curves = field_.known().curves;
  if (options.threads == 1 || !next || curves.contains(options.least_reach)) return at(threshold);
  core::CurveOptions later = options;
  later.least_reach = *next;
  const core::CurveInput in = input();
  core::CurveSkeleton curve;
  core::SheetMesh lines;
  // Each on all threads: what has more to do has them alone at the end.
  core::parallel_for(options.threads, 2, [&](std::size_t n) {
    if (n == 0)
      curve = core::curve_skeleton(in, options);
    else
      lines = core::curve_lines(in, later);
  });
  lines_.emplace(*next, std::move(lines));
  return curves.emplace(options.least_reach, std::move(curve)).first->second;
}

v1::SkeletonQuality CurveOfField::quality_of(const core::CurveSkeleton& curve, double threshold,
                                             Compared compared) const {
  core::SheetQualityOptions options;
  options.segments = curve.segments;
  core::Mesh other;
  if (const auto next = compared_to(threshold); next && compared == Compared::kToNext) {
    other =
        core::mesh_of(*next <= curve.same_to ? static_cast<const core::SheetMesh&>(curve) : lines_at(*next));
    options.other = &other;
    options.other_threshold = *next;
  }
  field_.throw_if_stopped();
  v1::SkeletonQuality message =
      quality_message(core::sheet_quality(field_.job().solid(), field_.lattice(), mesh_of(curve), options));
  message.set_threshold(threshold_of(threshold));
  ridge_.report_lattice(sheet_, message);
  message.set_branches(curve.branches);
  message.set_ends(curve.ends);
  message.set_opened(static_cast<std::uint32_t>(curve.opened.size()));
  for (std::size_t n = 0; n < std::min(kMaxPlaces, curve.opened.size()); ++n)
    set_place(field_.to_mesh(curve.opened[n].place), curve.opened[n].distance, *message.add_openings());
  if (message.advice().empty()) {
    if (curve.segments.empty()) add_advice({without_lines(curve, threshold_of(threshold)), {}}, message);
    // A higher threshold leaves out limbs, too.
    if (curve.opened.empty() && threshold_of(threshold) <= base::kMinCurveThreshold)
      add_advice(ridge_.flat_advice(curve), message);
  }
  add_advice(core::stretched_limbs_advice(field_.lattice()), message);
  return message;
}

v1::TriangleMesh CurveOfField::message_of(const core::CurveSkeleton& curve, double threshold,
                                          Compared compared) const {
  v1::TriangleMesh message;
  append_vertices(field_, curve, message);
  message.mutable_distance()->Add(curve.distance.begin(), curve.distance.end());
  message.mutable_share()->Add(curve.share.begin(), curve.share.end());
  message.mutable_beyond()->Add(curve.beyond.begin(), curve.beyond.end());
  for (const double radius : curve.radius) message.add_radius(radius);
  for (const std::uint32_t part : graph_of(curve).part) message.add_part(part + 1);
  append_segments(curve, message);
  *message.mutable_quality() = quality_of(curve, threshold, compared);
  return message;
}

std::vector<core::Vec3> CurveOfField::places_of(const core::CurveSkeleton& curve) const {
  std::vector<core::Vec3> places;
  for (const core::SheetVertex& vertex : curve.vertices) places.push_back(field_.to_mesh(vertex.position));
  return places;
}

core::CurveGraph CurveOfField::graph_of(const core::CurveSkeleton& curve) const {
  return core::curve_graph(places_of(curve), curve.segments, curve.radius, curve.share);
}

std::vector<std::uint32_t> parts_of_points(const core::CurveSkeleton& curve, const core::CurveGraph& graph) {
  std::vector<std::uint32_t> parts;
  parts.reserve(curve.nearest.size());
  for (const std::uint32_t vertex : curve.nearest) parts.push_back(graph.part[vertex] + 1);
  return parts;
}

}  // namespace affskel::worker
