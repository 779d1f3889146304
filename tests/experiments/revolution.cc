#include <algorithm>
#include <cmath>

#include "core/shapes/shapes.h"
#include "experiments.h"
#include "gallery.h"
#include "job.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

using core::Vec3;

struct Result {
  std::string name, directions;
  Job job;
  Cloud skeleton;
  std::vector<double>
      radius;  // largest distance from the z axis per fifth of the height, mesh units; from below

  Sheet sheet;

  double dt() const { return job.lattice.spacing; }
  // Largest distance of a shock of equal chords from the z axis.
  double chords() const {
    double greatest = 0;
    for (const Vec3& p : sheet.points.place) greatest = std::max(greatest, std::sqrt(p.x * p.x + p.y * p.y));
    return greatest;
  }
  double greatest() const { return *std::max_element(radius.begin(), radius.end()); }
};

Result measure(const std::string& name, const core::Mesh& mesh, const std::string& directions, double spacing,
               unsigned threads) {
  Result r{name, directions, compute(mesh, {spacing, directions, core::FrameKind::kAxis, threads}),
           {},   {},         {}};
  r.skeleton = zucker_hummel_skeleton(r.job);
  r.sheet = chord_sheet_of(r.job);
  r.radius.assign(5, 0);
  const double low = r.job.solid.bbox_min.z, height = r.job.solid.bbox_max.z - low;
  for (const Vec3& p : r.skeleton.place) {
    const auto fifth = static_cast<std::size_t>(std::clamp(5 * (p.z - low) / height, 0.0, 4.0));
    r.radius[fifth] = std::max(r.radius[fifth], std::sqrt(p.x * p.x + p.y * p.y));
  }
  return r;
}

std::vector<std::string> row(const Result& r) {
  std::vector<std::string> cells = {r.name, r.directions, format("%g", r.dt()),
                                    std::to_string(r.job.lattice.points), std::to_string(r.skeleton.size())};
  for (const double radius : r.radius) cells.push_back(format("%.0f", radius));
  cells.push_back(format("%.1f", r.greatest() / r.dt()));
  cells.push_back(format("%.1f", r.chords() / r.dt()));
  return cells;
}

Exhibit exhibit(const Result& r) {
  return {{r.name + format(", dT = %g", r.dt()), "directions " + r.directions},
          r.job.mesh,
          r.skeleton.place,
          r.skeleton.erosion,
          0.42 * r.dt(),
          {}};
}

std::string ends_and_waist(const Result& r) {
  return format("radius %.0f, %.0f, %.0f at bottom, middle and top", r.radius[0], r.radius[2], r.radius[4]);
}

constexpr const char* kText =
    "Published: an hourglass for the cylinder, and one with a side collapsed for the cone. With the "
    "mesh's own directions so it is here, whatever the spacing. **But it is the direction set's skeleton, "
    "not the solid's.** A cylinder's triangles have level normals and two upright ones and nothing "
    "between, so that E is the lesser of a cut parallel to the wall and one parallel to a lid, and the "
    "hourglass is where the two are equal. With planes of all directions the corner between wall and lid "
    "is cut off aslant, as at the corner of a box (E = 4.5 abc there), the level surfaces are round, and "
    "no shock runs to the rim. Only on the axis are the normals not unique: there all planes that leave "
    "through the wall alone cut off the same volume, however they are tilted. With a sphere's directions "
    "the skeleton found shrinks onto the axis as the spacing falls: its greatest radius stays about 3.5 "
    "spacings, the blur of the operator, and the shocks of `chords` lie within two of it. Of the "
    "cone's skeleton a small bowl on a stalk stays, about the deepest point; on the axis above it one "
    "plane, the level one, cuts off the least, and there is no shock. The points at the tip and the ring "
    "at the rim keep their size in voxels when the spacing falls: there the level surfaces bend within a "
    "few voxels.";

}  // namespace

void revolution_experiment(const Setting& setting, Report& report) {
  const double dt = setting.spacing();
  const std::string sphere_set = setting.quick ? "sphere:320" : "sphere:5000";
  const core::Mesh cylinder = core::make_cylinder(1500, 4500, 64);
  const core::Mesh cone = core::make_cone(2000, 4500, 64);
  std::vector<Result> results;
  for (const std::string& directions : {std::string("triangles"), sphere_set}) {
    for (const double spacing : {dt, dt / 4}) {
      results.push_back(measure("cylinder", cylinder, directions, spacing, setting.threads));
      results.push_back(measure("cone", cone, directions, spacing, setting.threads));
    }
  }
  report.section("Cylinder and cone (6.1, figures 6.6 and 6.7)");
  Table table{{"solid", "directions", "dT", "points", "skeleton", "radius, lowest fifth", "2nd", "3rd", "4th",
               "highest fifth", "greatest, spacings", "of `chords`, spacings"},
              {}};
  for (const Result& r : results) table.rows.push_back(row(r));
  report.table(table);
  report.text("Radii are the largest distances of skeleton points from the axis, mesh units, by height.");
  const std::vector<std::size_t> shown = {0, 1, 4, 5, 6, 7};
  std::vector<Exhibit> exhibits;
  for (const std::size_t r : shown) exhibits.push_back(exhibit(results[r]));
  report.picture("revolution", gallery(exhibits, {{Side::kFront, Side::kOblique}, 2400}),
                 "Cylinder and cone with the mesh's own directions and with a sphere's");
  report.text(kText);

  const Result &hourglass = results[0], &half_hourglass = results[1], &spindle = results[6];
  const double waist = hourglass.radius[2], ends = std::min(hourglass.radius[0], hourglass.radius[4]);
  const std::string away =
      format("; with %s within %.0f and %.0f of the axis at dT %g and %g (chords: %.0f and %.0f)",
             sphere_set.c_str(), results[4].greatest(), spindle.greatest(), results[4].dt(), spindle.dt(),
             results[4].chords(), spindle.chords());
  report.compare({"cylinder", "an hourglass", ends_and_waist(hourglass) + away,
                  "agrees with the mesh's directions; with all directions the skeleton is the axis"});
  report.compare({"cone", "an hourglass with one side collapsed", ends_and_waist(half_hourglass),
                  "agrees with the mesh's directions; with all directions a small bowl about the deepest "
                  "point stays"});
  for (const Result& r : results) {
    const std::string what = r.name + ", " + r.directions + format(", dT %g", r.dt());
    report.expect(what + ": skeleton points", static_cast<double>(r.skeleton.size()), 10, 40000);
    report.expect(what + ": largest E / v0", r.job.highest_share(), 0.2, 0.75);
  }
  report.expect("cylinder: radius of the ends over that of the waist", ends / std::max(waist, 0.1 * dt),
                setting.quick ? 1 : 2, 100);
  report.expect("cylinder, " + sphere_set + ": greatest radius of chords, spacings",
                spindle.chords() / spindle.dt(), 0, setting.quick ? 3 : 2);
  report.expect("cylinder, " + sphere_set + ": greatest radius, spacings", spindle.greatest() / spindle.dt(),
                0.5, 4.5);
}

}  // namespace affskel::experiments
