#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "chart.h"
#include "core/shapes.h"
#include "experiments.h"
#include "job.h"

namespace affskel::experiments {
namespace {

using core::Vec3;

// The product of three numbers, each at most a third; nothing when one is larger.
std::optional<double> product_of_thirds(std::array<double, 3> thirds) {
  if (*std::max_element(thirds.begin(), thirds.end()) > 1.0 / 3 + 1e-12) return std::nullopt;
  return thirds[0] * thirds[1] * thirds[2];
}

// E / v0 of a box, where a corner's rule holds: 4.5 a b c for distances a, b, c from three faces, in edges.
std::optional<double> box_level(const Vec3& p, const Vec3& low, const Vec3& high) {
  std::array<double, 3> share{};
  for (int k = 0; k < 3; ++k) {
    const double t = (p[k] - low[k]) / (high[k] - low[k]);
    share[static_cast<std::size_t>(k)] = std::min(t, 1 - t);
  }
  const auto product = product_of_thirds(share);
  return product ? std::optional(4.5 * *product) : std::nullopt;
}

// E / v0 of a tetrahedron where its rule holds: 27 times the product of the three least barycentric
// coordinates.
std::optional<double> tetrahedron_level(const Vec3& p, const core::Mesh& mesh) {
  std::array<double, 4> share{};
  double sum = 0;
  for (std::size_t t = 0; t < 4; ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 q = mesh.points[a];
    // Proportional to the distance from the face, all faces being alike.
    share[t] = core::dot(q - p, core::cross(mesh.points[b] - q, mesh.points[c] - q));
    sum += share[t];
  }
  for (double& s : share) s /= sum;
  std::sort(share.begin(), share.end());
  const auto product = product_of_thirds({share[0], share[1], share[2]});
  return product ? std::optional(27 * *product) : std::nullopt;
}

struct Row {
  std::string directions;
  std::size_t count = 0;  // of directions
  std::size_t known = 0;  // points with a known E
  double mean = 0;        // of E / E_known - 1
  double greatest = 0, least = 0;
};

using KnownLevel = std::function<std::optional<double>(const Vec3&)>;

Row measure(const core::Mesh& mesh, double spacing, const std::string& directions, const KnownLevel& level,
            unsigned threads) {
  const Job job = compute(mesh, {spacing, directions, core::FrameKind::kAxis, threads});
  const Cloud points = all_points(job);
  Row row{directions, job.directions.size(), 0, 0, 0, 1e300};
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto known = level(points.place[p]);
    if (!known) continue;
    const double error = points.erosion[p] / (*known * job.solid.volume) - 1;
    ++row.known;
    row.mean += error;
    row.greatest = std::max(row.greatest, error);
    row.least = std::min(row.least, error);
  }
  row.mean /= static_cast<double>(row.known);
  return row;
}

struct Subject {
  std::string name, colour;
  core::Mesh mesh;
  double spacing;
  KnownLevel level;
};

std::vector<Subject> subjects() {
  const core::Mesh cube = core::make_box(1, 1, 1), tetrahedron = core::make_tetrahedron(1);
  return {{"cube", "#1b9e77", cube, 1.0 / 20,
           [](const Vec3& p) {
             return box_level(p, {0, 0, 0}, {1, 1, 1});
           }},
          {"tetrahedron", "#d95f02", tetrahedron, 1.0 / 32,
           [tetrahedron](const Vec3& p) { return tetrahedron_level(p, tetrahedron); }}};
}

// The slope of log(mean error) against log(N), by the first and the last row.
double slope(const std::vector<Row>& rows) {
  return std::log(rows.back().mean / rows.front().mean) /
         std::log(static_cast<double>(rows.back().count) / static_cast<double>(rows.front().count));
}

}  // namespace

void plane_experiment(const Setting& setting, Report& report) {
  const std::vector<int> counts =
      setting.quick ? std::vector<int>{80, 320, 1280} : std::vector<int>{80, 320, 1280, 5120, 20480};
  report.section("Directions of the planes (6.5.1, figure 6.22)");
  Table table{{"solid", "directions", "their number", "points with known E", "mean error", "greatest error"},
              {}};
  Chart chart;
  chart.title = "Error of E at points where it is known, directions sphere:N";
  chart.x = {"directions N", 50, 50000, true};
  chart.y = {"relative error of E, %", 0.001, 1000, true};
  std::string here;
  for (const Subject& subject : subjects()) {
    const Row own = measure(subject.mesh, subject.spacing, "triangles", subject.level, setting.threads);
    std::vector<Row> rows;
    Line mean{subject.name + ", mean", subject.colour, false, true, {}};
    Line greatest{subject.name + ", greatest", subject.colour, true, true, {}};
    for (const int count : counts) {
      rows.push_back(measure(subject.mesh, subject.spacing, "sphere:" + std::to_string(count), subject.level,
                             setting.threads));
      const auto n = static_cast<double>(rows.back().count);
      mean.points.push_back({n, 100 * rows.back().mean});
      greatest.points.push_back({n, 100 * rows.back().greatest});
    }
    const double level = 100 * own.mean;
    chart.lines.insert(
        chart.lines.end(),
        {mean,
         greatest,
         {subject.name + ", triangles, mean", subject.colour, true, false, {{50, level}, {5e4, level}}}});
    const double exponent = slope(rows);
    here += (here.empty() ? "" : "; ") + subject.name +
            format(": mean error %.0f %% with triangles, %.2g %% with %zu, as N^%.2f", level,
                   100 * rows.back().mean, rows.back().count, exponent);
    std::vector<Row> all = {own};
    all.insert(all.end(), rows.begin(), rows.end());
    for (const Row& row : all) {
      table.rows.push_back({subject.name, row.directions, std::to_string(row.count),
                            std::to_string(row.known), format("%.3g %%", 100 * row.mean),
                            format("%.3g %%", 100 * row.greatest)});
      report.expect(subject.name + ", " + row.directions + ": least error of E", row.least, -1e-9, 100);
    }
    report.expect(subject.name + ": exponent of the mean error", exponent, -1.4, -0.6);
  }
  report.table(table);
  report.drawing("planes", svg_of(chart), "Error of E against the number of directions");
  report.text(
      "Published: the method cannot cope with a cube or a tetrahedron, whose triangles have six and four "
      "normals; "
      "proposed, but not tried, is a triangulated sphere round the object whose normals are taken instead. "
      "It "
      "works. Points: those of a lattice where E has a closed form, 4.5 abc for distances a, b, c (in edges, "
      "each "
      "at most 1/3) from three faces of a cube, 27 v0 times the product of the three least barycentric "
      "coordinates (each at most 1/3) in a tetrahedron. A finite set can only overestimate E. The error "
      "falls "
      "like 1/N: E is a minimum over directions, flat to first order there, and the nearest of N directions "
      "is "
      "about N^(-1/2) away.");
  report.compare({"cube and tetrahedron, directions of a sphere", "proposed, not tried", here, "works"});
}

}  // namespace affskel::experiments
