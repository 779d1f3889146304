// The barrier at the vertices of sheets: what of them are strict shocks.
#include "core/barrier/barriers.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/matrix3.h"
#include "core/base/stopwatch.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/ridge/ridge_sheet.h"
#include "core/shapes/shapes.h"
#include "experiments.h"
#include "fields.h"
#include "gallery.h"
#include "job.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

constexpr double kShock = 0.05;  // the barrier above which the pictures show a triangle

// A sheet with its barriers, mesh units.
struct Result {
  std::string solid, operator_name;
  core::Mesh mesh;
  std::vector<double> barrier;  // per vertex
  double seconds = 0;           // for the barriers

  double share_below(double level) const {
    const auto low = std::ranges::count_if(barrier, [&](double b) { return b < level; });
    return static_cast<double>(low) / static_cast<double>(barrier.size());
  }
  double quantile(double share) const {
    std::vector<double> sorted = barrier;
    std::ranges::sort(sorted);
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
};

template <class Sheet>
Result measure(const std::string& solid, const std::string& operator_name, const Job& job, const Sheet& sheet,
               const Setting& setting) {
  Result r{solid, operator_name, {}, {}, 0};
  const core::SamplePlaces places(job.solid, job.lattice);
  core::BarrierOptions options;
  if (setting.quick) options.directions = 642;
  options.frame = core::frame_matrix(job.lattice);
  options.threads = setting.threads;
  const core::Matrix3 normals = core::inverse_transposed(options.frame);
  std::vector<core::SheetPlace> asked;
  for (const core::SheetVertex& v : sheet.vertices) {
    const core::Vec3 a = normals * v.normal_a, b = normals * v.normal_b;
    r.mesh.points.push_back(places.origin() + options.frame * v.position);
    if (v.turns) {
      asked.emplace_back();
      continue;
    }
    asked.push_back({core::scaled_place(job.lattice, (1 / job.lattice.spacing) * v.position),
                     (1 / core::norm(a)) * a, (1 / core::norm(b)) * b});
  }
  r.mesh.triangles = sheet.triangles;
  const core::Stopwatch watch;
  r.barrier = core::barriers(job.solid, asked, options);
  r.seconds = watch.seconds();
  return r;
}

std::vector<Result> measure_both(const std::string& solid, const Job& job, const Setting& setting) {
  const core::FrameField field = core::frame_field(job.lattice, job.directions, job.values);
  const core::RidgeBasis basis = core::ridge_basis(job.solid, job.lattice, field);
  return {measure(solid, "`chords`", job, chord_sheet(job, field), setting),
          measure(solid, "`ridge`", job, core::ridge_sheet(job.solid, job.lattice, field, basis), setting)};
}

Result measure_infimum(const std::string& solid, const core::Mesh& mesh, double spacing,
                       const Setting& setting) {
  Fields fields(mesh, grid_round(mesh, spacing), kSeeds, setting.threads);
  fields.go_on();
  const Job& job = fields.job();
  const core::FrameField field = core::frame_field(job.lattice, job.directions, job.values);
  return measure(solid, "`chords`, infimum", job, chord_sheet(job, field), setting);
}

core::Mesh elliptic_cylinder(std::uint32_t sides) {
  core::Mesh mesh = core::make_cylinder(1200, 9000, sides);
  for (core::Vec3& p : mesh.points) p.y *= 0.5;
  return mesh;
}

std::vector<std::string> row(const Result& r) {
  if (r.barrier.empty()) return {r.solid, r.operator_name, "0", "-", "-", "-", "-", "-", "-", "-"};
  const auto percent = [](double share) { return format("%.0f %%", 100 * share); };
  return {r.solid,
          r.operator_name,
          std::to_string(r.barrier.size()),
          percent(r.share_below(0.001)),
          percent(r.share_below(0.01)),
          percent(r.share_below(kShock)),
          percent(1 - r.share_below(0.15)),
          format("%.2g %%", 100 * r.quantile(0.5)),
          format("%.2g %%", 100 * r.quantile(1)),
          duration(r.seconds)};
}

// The triangles all of whose vertices have a barrier from `least` on.
core::Mesh part_above(const Result& r, double least) {
  core::Mesh part = r.mesh;
  std::erase_if(part.triangles, [&](const core::Triangle& t) {
    return std::ranges::any_of(t, [&](std::uint32_t v) { return r.barrier[v] < least; });
  });
  return part;
}

Exhibit exhibit(const Result& r, const core::Mesh& solid, double least) {
  const std::string what = least > 0 ? format("barrier from %.0f %% on", 100 * least) : "the whole sheet";
  return {{r.solid + ", " + r.operator_name.substr(1, r.operator_name.size() - 2), what},
          solid,
          {},
          {},
          0,
          part_above(r, least)};
}

// Of the two results of a solid, `chords` first.
std::string explanation(const Result& body_chords, const Result& body_ridge) {
  return format(
      "At a vertex p of a sheet let f(d) be the chord of p along d. The *barrier* is the share by which "
      "the lowest level at which a path of directions leads from the optimal direction of one side to "
      "that of the other lies above the higher of the two minima: the persistence of f's second minimum. "
      "It asks what no angle between two lattice points can: whether the normals jump, as the definition "
      "of the affine skeleton wants, or only turn fast. In ellipsoid, limb and box they jump nowhere on "
      "the sheets that are shown for them: the chords of both sides are joined by others that are hardly "
      "larger, in the flat box by equal ones (a plane that turns about a line half-way between two faces "
      "cuts off the same). What is not 0 there is the grain of the directions, up to a hundredth. In the "
      "tetrahedron most of the sheet of `chords` is a true shock; most of the ridge, which asks for fast "
      "turns and not for equal chords, is none. The body is between: half of `chords` has less than %.1f "
      "%%, half of `ridge` less than %.1f %%. %.0f %% of `chords` and %.0f %% of `ridge` have more than "
      "%.0f %%: of `chords` the lower legs, the upper arms and patches of the trunk. The ridge's sheet of "
      "the trunk jumps hardly anywhere. The barrier is that of a place: half a spacing beside a shock the "
      "second minimum may be gone.",
      100 * body_chords.quantile(0.5), 100 * body_ridge.quantile(0.5),
      100 * (1 - body_chords.share_below(kShock)), 100 * (1 - body_ridge.share_below(kShock)), 100 * kShock);
}

}  // namespace

void barrier_experiment(const Setting& setting, Report& report) {
  const std::uint32_t triangles = setting.quick ? 500 : 5000;
  const std::string sphere = setting.quick ? "sphere:320" : "sphere:5000";
  const double dt = setting.spacing();
  const core::Mesh body = setting.body(triangles);
  std::vector<Result> results;
  const auto add = [&](const std::string& name, const core::Mesh& mesh, double spacing,
                       const std::string& directions) {
    const Job job = compute(mesh, {spacing, directions, core::FrameKind::kAxis, setting.threads});
    for (Result& r : measure_both(name, job, setting)) results.push_back(std::move(r));
  };
  add(format("body of %u triangles", triangles), body, 0.75 * dt, "triangles");
  add("limb: elliptic cylinder 2:1", elliptic_cylinder(setting.quick ? 24 : 48), dt, "triangles+" + sphere);
  const core::Mesh ellipsoid = core::make_ellipsoid(3600, 2400, 1200, setting.quick ? 320 : 1280);
  add("ellipsoid 3:2:1", ellipsoid, dt, "triangles");
  add("box 6:3:1", core::make_box(7200, 3600, 1200), dt, sphere);
  add("tetrahedron", core::make_tetrahedron(7200), dt, sphere);
  results.push_back(measure_infimum(format("body of %u triangles", triangles), body, 0.75 * dt, setting));
  results.push_back(measure_infimum("ellipsoid 3:2:1", ellipsoid, dt, setting));
  results.push_back(measure_infimum("tetrahedron", core::make_tetrahedron(7200), dt, setting));
  report.section("Jumps and fast turns: the barrier between the two sides of a sheet");
  Table table{{"solid", "sheet", "vertices", "barrier below 0.1 %", "below 1 %", "below 5 %", "15 % and more",
               "median", "greatest", "time"},
              {}};
  for (const Result& r : results) table.rows.push_back(row(r));
  report.table(table);
  report.picture("barrier",
                 gallery({exhibit(results[0], body, 0), exhibit(results[0], body, kShock),
                          exhibit(results[1], body, 0), exhibit(results[1], body, kShock)},
                         {{Side::kFront}, 2000}),
                 "The sheets of a body, whole and where their normals jump");
  report.text(explanation(results[0], results[1]));
  const double grain = setting.quick ? 0.15 : 0.01;  // fewer directions lie farther apart
  for (const Result& r : results) {
    const std::string what = r.solid + ", " + r.operator_name;
    if (r.solid == "tetrahedron") continue;
    const bool smooth = r.solid.find("body") == std::string::npos;
    if (!smooth && r.operator_name.find("infimum") != std::string::npos) continue;
    report.expect(what + format(": share of barriers below %g", grain), r.share_below(grain),
                  smooth ? 0.99 : 0.3, 1);
  }
  // At its centroid 5/27 and nowhere more.
  report.expect("tetrahedron, `chords`: greatest barrier", results[8].quantile(1), 0.1, 5.0 / 27 + grain);
  report.expect("tetrahedron, `chords`, infimum: greatest barrier", results.back().quantile(1), 0.1,
                5.0 / 27 + grain);
}

}  // namespace affskel::experiments
