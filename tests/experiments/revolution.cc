#include <algorithm>
#include <cmath>

#include "core/shapes.h"
#include "experiments.h"
#include "gallery.h"
#include "job.h"

namespace affskel::experiments {
namespace {

using core::Vec3;

struct Result {
  std::string name, directions;
  Job job;
  Cloud skeleton;
  std::vector<double>
      radius;  // largest distance from the z axis per fifth of the height, spacings; from below
};

Result measure(const std::string& name, const core::Mesh& mesh, const std::string& directions,
               const Setting& setting) {
  Result r{name,
           directions,
           compute(mesh, {setting.spacing(), directions, core::FrameKind::kAxis, setting.threads}),
           {},
           {}};
  r.skeleton = zucker_hummel_skeleton(r.job);
  r.radius.assign(5, 0);
  const double low = r.job.solid.bbox_min.z, height = r.job.solid.bbox_max.z - low;
  for (const Vec3& p : r.skeleton.place) {
    const auto fifth = static_cast<std::size_t>(std::clamp(5 * (p.z - low) / height, 0.0, 4.0));
    const double radius = std::sqrt(p.x * p.x + p.y * p.y) / r.job.lattice.spacing;
    r.radius[fifth] = std::max(r.radius[fifth], radius);
  }
  return r;
}

std::vector<std::string> row(const Result& r) {
  std::vector<std::string> cells = {r.name, r.directions, std::to_string(r.job.lattice.points),
                                    std::to_string(r.skeleton.size()),
                                    std::to_string(piece_sizes(r.job, r.skeleton).size())};
  for (const double radius : r.radius) cells.push_back(format("%.1f", radius));
  return cells;
}

Exhibit exhibit(const Result& r) {
  return {{r.name, "directions " + r.directions}, r.job.mesh, r.skeleton.place, r.skeleton.erosion,
          0.42 * r.job.lattice.spacing,           {}};
}

}  // namespace

void revolution_experiment(const Setting& setting, Report& report) {
  const std::uint32_t segments = 64;
  const std::string sphere_set = setting.quick ? "sphere:320" : "sphere:5000";
  const core::Mesh cylinder = core::make_cylinder(1500, 4500, segments);
  const core::Mesh cone = core::make_cone(2000, 4500, segments);
  std::vector<Result> results;
  for (const std::string& directions : {std::string("triangles"), sphere_set}) {
    results.push_back(measure("cylinder", cylinder, directions, setting));
    results.push_back(measure("cone", cone, directions, setting));
  }
  report.section("Cylinder and cone (6.1, figures 6.6 and 6.7)");
  Table table{{"solid", "directions", "points", "skeleton", "pieces", "radius, lowest fifth", "2nd", "3rd",
               "4th", "highest fifth"},
              {}};
  for (const Result& r : results) table.rows.push_back(row(r));
  report.table(table);
  std::vector<Exhibit> shown;
  for (const Result& r : results) shown.push_back(exhibit(r));
  report.picture("revolution", gallery(shown, {{Side::kFront, Side::kOblique}, 2000}),
                 "Cylinder and cone with the mesh's own directions and with a sphere's");
  report.text("Radii are the largest distances of skeleton points from the axis, in spacings.");
  const Result& hourglass = results[0];
  const double waist = hourglass.radius[2], ends = std::min(hourglass.radius[0], hourglass.radius[4]);
  report.compare({"cylinder", "an hourglass",
                  format("radius %.1f, %.1f, %.1f spacings at the bottom, waist and top", hourglass.radius[0],
                         waist, hourglass.radius[4]),
                  ends > waist ? "agrees" : "disagrees"});
  const Result& collapsed = results[1];
  report.compare({"cone", "an hourglass with one side collapsed",
                  format("radius %.1f, %.1f, %.1f spacings at the base, middle and tip", collapsed.radius[0],
                         collapsed.radius[2], collapsed.radius[4]),
                  collapsed.radius[0] > collapsed.radius[4] ? "agrees" : "disagrees"});
  for (const Result& r : results) {
    const std::string what = r.name + ", " + r.directions;
    report.expect(what + ": skeleton points", static_cast<double>(r.skeleton.size()), 10, 5000);
    report.expect(what + ": largest E / v0", r.job.highest_share(), 0.2, 0.75);
  }
  report.expect("cylinder: radius of the ends over that of the waist", ends / std::max(waist, 0.1), 1, 100);
}

}  // namespace affskel::experiments
