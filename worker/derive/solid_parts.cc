#include "derive/solid_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/none.h"
#include "core/base/parallel.h"
#include "core/collapse/dual_complex.h"
#include "core/curve/parted_surface.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/ridge/local_thickness.h"
#include "core/spatial/point_index.h"
#include "core/surface/surface_thickness.h"
#include "derive/curve_of_field.h"
#include "derive/messages.h"
#include "derive/ridge_of_field.h"

namespace affskel::worker {
namespace {

v1::PartKind kind_message(core::BranchKind kind) {
  switch (kind) {
    case core::BranchKind::kLimb:
      return v1::PART_KIND_LIMB;
    case core::BranchKind::kLine:
      return v1::PART_KIND_LINE;
    case core::BranchKind::kLink:
      return v1::PART_KIND_LINK;
    case core::BranchKind::kLoop:
      return v1::PART_KIND_LOOP;
    case core::BranchKind::kPoint:
      return v1::PART_KIND_POINT;
  }
  return v1::PART_KIND_UNSPECIFIED;
}

class Parts {
 public:
  Parts(const FinishedField& field, double threshold)
      : field_(field),
        solid_(field.job().solid()),
        ridge_(field),
        sheet_(ridge_.sheet(0)),
        curves_(field, ridge_),
        curve_(curves_.at(threshold)),
        graph_(curves_.graph_of(curve_)),
        points_(parts_of_points(curve_, graph_)) {
    core::parallel_for(field.threads(), 2, [&](std::size_t n) {
      if (n == 0)
        *message_.mutable_curve() = curves_.message_of(curve_, threshold, CurveOfField::Compared::kNo);
      else
        surface_ = core::parted_surface(solid_, field.lattice(), points_, field.context());
    });
  }

  v1::SolidParts run() {
    add_parts();
    message_.mutable_point_part()->Add(points_.begin(), points_.end());
    add_surface();
    add_thickness();
    for (const core::Triangle& triangle : sheet_.triangles)
      message_.set_sheet_area(message_.sheet_area() + area_of_sheet(triangle));
    add_greatest();
    return std::move(message_);
  }

 private:
  core::Vec3 to_mesh(const core::Vec3& scaled) const { return solid_.centre + solid_.scale() * scaled; }

  void add_parts() {
    for (const core::CurveBranch& branch : graph_.branches) {
      v1::SolidPart& part = *(branch.share > 0 ? message_.add_parts() : message_.add_links());
      part.set_kind(kind_message(branch.kind));
      append(place_of(branch.vertices.front()), part.mutable_from());
      append(place_of(branch.vertices.back()), part.mutable_to());
      part.set_length(branch.length);
      part.set_straight_length(branch.straight_length);
      part.set_volume(branch.share * solid_.volume);
      part.set_volume_share(branch.share);
      part.set_mean_radius(branch.mean_radius);
      part.set_least_radius(branch.least_radius);
      part.set_greatest_radius(branch.greatest_radius);
      if (std::isfinite(branch.angle)) part.set_angle(branch.angle);
      // A branch without a share is no part; those come last, so that branches and parts have the same numbers.
      if (branch.angle_to != core::kNone && graph_.branches[branch.angle_to].share > 0)
        part.set_angle_to(branch.angle_to + 1);
      part.mutable_vertices()->Add(branch.vertices.begin(), branch.vertices.end());
    }
  }

  core::Vec3 place_of(std::uint32_t vertex) const { return field_.to_mesh(curve_.vertices[vertex].position); }

  // A triangle without a sample point next to it belongs to the part of the nearest vertex.
  void add_surface() {
    std::vector<core::Vec3> places;
    for (std::uint32_t v = 0; v < curve_.vertices.size(); ++v) places.push_back(place_of(v));
    const core::PointIndex index(places);
    for (const core::Vec3& point : surface_.mesh.points)
      append(to_mesh(point), message_.mutable_surface()->mutable_xyz());
    append_corners(surface_.mesh, *message_.mutable_surface());
    for (std::size_t t = 0; t < surface_.mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = surface_.mesh.triangles[t];
      const core::Vec3 p = to_mesh(surface_.mesh.points[a]), q = to_mesh(surface_.mesh.points[b]),
                       r = to_mesh(surface_.mesh.points[c]);
      const std::uint32_t point = surface_.point[t];
      const std::uint32_t part = point != core::kNone
                                     ? points_[point]
                                     : graph_.part[index.find((1.0 / 3) * (p + (q + r))).number] + 1;
      const double area = 0.5 * core::norm(core::cross(q - p, r - p));
      message_.add_triangle_part(part);
      v1::SolidPart& owner = *message_.mutable_parts(static_cast<int>(part) - 1);
      owner.set_surface_area(owner.surface_area() + area);
      message_.set_surface_area(message_.surface_area() + area);
    }
  }

  core::Mesh skeleton_in_solid() const {
    core::Mesh skeleton;
    const double step = 1 / field_.lattice().spacing;
    for (const core::SheetVertex& vertex : sheet_.vertices)
      skeleton.points.push_back(core::scaled_place(field_.lattice(), step * vertex.position));
    skeleton.triangles = sheet_.triangles;
    for (const auto& [a, b] : sheet_.segments) skeleton.triangles.push_back({a, b, b});
    if (skeleton.triangles.empty()) skeleton.triangles.push_back({0, 0, 0});
    return skeleton;
  }

  void add_thickness() {
    std::vector<core::Vec3> inward;
    inward.reserve(surface_.point.size());
    for (const std::uint32_t point : surface_.point)
      inward.push_back(point == core::kNone ? core::Vec3{} : field_.normal(point));
    const core::RidgeBasis& basis = ridge_.basis();
    double spacing = 0;  // scaled units, in a frame that is stretched the longest
    for (const core::Vec3& axis : field_.lattice().grid.axes) spacing = std::max(spacing, core::norm(axis));
    std::vector<double> about;
    for (const float radius : core::local_thickness(basis.complex, basis.radius, surface_.point,
                                                    {field_.threads(), field_.context()}))
      about.push_back(spacing * static_cast<double>(radius));
    const core::ThicknessOptions options{0.5 * spacing, field_.threads(), field_.context()};
    for (const double thickness :
         core::surface_thickness(solid_, surface_.mesh, skeleton_in_solid(), inward, about, options))
      message_.add_thickness(thickness * solid_.scale());
  }

  double area_of_sheet(const core::Triangle& triangle) const {
    const auto at = [&](std::size_t k) { return field_.to_mesh(sheet_.vertices[triangle[k]].position); };
    return 0.5 * core::norm(core::cross(at(1) - at(0), at(2) - at(0)));
  }

  // In a plate many points have the greatest E.
  void add_greatest() {
    const std::vector<double>& erosion = field_.in_frame().erosion;
    const double greatest = *std::max_element(erosion.begin(), erosion.end());
    std::vector<std::uint32_t> having;
    for (std::uint32_t p = 0; p < erosion.size(); ++p)
      if (erosion[p] == greatest) having.push_back(p);
    std::vector<core::Vec3> places;
    core::Vec3 centre;
    for (const core::LatticePlace& place : core::lattice_places(field_.lattice(), having)) {
      places.push_back(field_.place(place));
      centre = centre + (1.0 / static_cast<double>(having.size())) * places.back();
    }
    message_.set_greatest_erosion(greatest);
    append(*std::min_element(places.begin(), places.end(),
                             [&](const core::Vec3& a, const core::Vec3& b) {
                               return core::norm(a - centre) < core::norm(b - centre);
                             }),
           message_.mutable_greatest_place());
  }

  const FinishedField& field_;
  const core::Solid& solid_;
  const RidgeOfField ridge_;
  const core::RidgeSheet& sheet_;
  const CurveOfField curves_;
  const core::CurveSkeleton& curve_;
  const core::CurveGraph graph_;
  const std::vector<std::uint32_t> points_;  // per sample point, its part
  core::PartedSurface surface_;
  v1::SolidParts message_;
};

}  // namespace

v1::SolidParts solid_parts(const FinishedField& field, const v1::SkeletonParams& params) {
  return Parts(field, params.threshold()).run();
}

}  // namespace affskel::worker
