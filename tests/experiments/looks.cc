#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/mesh/edges.h"
#include "core/mesh/map_mesh.h"
#include "core/ridge/local_depth.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"
#include "experiments.h"
#include "job.h"
#include "limb_ends.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

constexpr double kRimTurn = 45, kWayTurn = 30;  // degrees
constexpr double kNear = 0.3;                   // of the local depth
constexpr double kNoArea = 1e-5;                // squared spacings
constexpr double kMostTurns = 2;                // percent

// How many places there are of a kind, and of how many something is so.
struct Share {
  std::size_t all = 0, with = 0;

  void count(bool is_so) {
    ++all;
    with += is_so;
  }
  double percent() const {
    return 100 * static_cast<double>(with) / static_cast<double>(std::max<std::size_t>(1, all));
  }
  std::string text() const { return format("%zu of %zu", with, all); }
};

core::Adjacency along_rims(const core::Mesh& mesh) {
  std::vector<core::Segment> rims;
  core::Edges(mesh.points.size(), mesh.triangles)
      .for_each([&](std::uint32_t a, std::uint32_t b, const auto& sides) {
        if (sides.size() == 1) rims.push_back({a, b});
      });
  return core::neighbours(mesh.points.size(), rims);
}

// Of the vertices with two neighbours: those at which the line turns by more than the angle, in degrees.
template <class Counts>
Share turns(const std::vector<core::Vec3>& at, const core::Adjacency& neighbours, double angle,
            const Counts& counts) {
  Share share;
  const double least = std::cos(angle * std::numbers::pi / 180);
  for (std::uint32_t v = 0; v < at.size(); ++v) {
    if (neighbours[v].size() != 2 || !counts(v)) continue;
    const core::Vec3 before = at[v] - at[neighbours[v][0]], after = at[neighbours[v][1]] - at[v];
    share.count(dot(before, after) < least * norm(before) * norm(after));
  }
  return share;
}

Share near_the_surface(const Job& job, const Sheet& sheet) {
  const auto field = core::frame_field(job.lattice, job.directions, job.values);
  const std::vector<float> depth = core::local_depth(job.lattice, field);
  const core::DistanceToMesh surface(job.mesh);
  Share share;
  for (std::size_t v = 0; v < sheet.points.size(); ++v) {
    const double deep = job.lattice.spacing * static_cast<double>(depth[sheet.points.rank[v]]);
    share.count(surface.nearest(sheet.points.place[v]) < kNear * deep);
  }
  return share;
}

Share without_area(const Job& job, const core::Mesh& mesh) {
  const double least = kNoArea * job.lattice.spacing * job.lattice.spacing;
  Share share;
  for (const auto& [a, b, c] : mesh.triangles) {
    const core::Vec3& corner = mesh.points[a];
    share.count(0.5 * norm(cross(mesh.points[b] - corner, mesh.points[c] - corner)) <= least);
  }
  return share;
}

core::Vec3 mirrored(const core::Vec3& place) {
  return {-place.x, place.y, place.z};
}

// Of the vertices, those that the other skeleton, mirrored, is farther from than a spacing.
Share unlike(const Sheet& sheet, const Sheet& other, double spacing) {
  const core::PointIndex index(other.mesh.points);
  Share share;
  for (const core::Vec3& place : sheet.mesh.points) share.count(index.nearest(mirrored(place)) > spacing);
  return share;
}

void study(const NamedMesh& solid, const Setting& setting, Table& table, Report& report) {
  const JobOptions options = comparison_options(solid.mesh, setting);
  const Job job = compute(solid.mesh, options);
  const Sheet sheet = ridge_sheet_of(job),
              image = ridge_sheet_of(compute(core::map_mesh(core::scaling(-1, 1, 1), solid.mesh), options));
  const auto& at = sheet.mesh.points;
  const Share rims = turns(at, along_rims(sheet.mesh), kRimTurn, [](std::uint32_t) { return true; });
  const core::Adjacency lines = core::neighbours(at.size(), sheet.segments);
  const auto is_way = [&](std::uint32_t v) { return sheet.kind[v] == core::SkeletonKind::kWay; };
  const Share ways = turns(at, lines, kWayTurn, is_way);
  const Share curves = turns(at, lines, kWayTurn, [&](std::uint32_t v) { return !is_way(v); });
  const Share near = near_the_surface(job, sheet), flat = without_area(job, sheet.mesh);
  const Share one_sided = unlike(sheet, image, job.lattice.spacing);
  table.rows.push_back({solid.name, rims.text(), format("%.1f", rims.percent()), ways.text(), curves.text(),
                        flat.text(), format("%.2f", near.percent()), format("%.1f", one_sided.percent())});
  if (setting.quick) return;  // too coarse
  const auto expect = [&](const char* what, double value, double most) {
    report.expect(solid.name + ": " + what, value, 0, most);
  };
  expect("percent of the rims that turn sharply", rims.percent(), kMostTurns);
  expect("turns of ways", static_cast<double>(ways.with), 0);
  expect("triangles without area", static_cast<double>(flat.with), 0);
  expect("percent of the vertices near the surface", near.percent(), 1);
}

}  // namespace

void looks_experiment(const Setting& setting, Report& report) {
  report.section("How the ridge looks");
  report.text(
      "Not published: of the skeleton of `ridge` at 100,000 points, how many of the vertices along rims turn by more than "
      "45 degrees (at most 2 % may), how many of those along ways and along curves by more than 30 (of ways none may), how "
      "many triangles have no area (none may), which share of the vertices is nearer to the surface than 0.3 of the local "
      "depth (1 % at most), and which is farther than a spacing from the mirror image of the mirrored solid's skeleton.");
  Table table{{"solid", "rims that turn", "percent", "ways", "curves", "no area", "near the surface, %",
               "one-sided, %"},
              {}};
  for (const NamedMesh& solid : solids_to_compare(setting)) study(solid, setting, table, report);
  report.table(table);
}

}  // namespace affskel::experiments
