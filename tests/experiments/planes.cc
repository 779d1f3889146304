#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "chart.h"
#include "core/shapes/shapes.h"
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
  std::size_t count = 0;                                 // of directions
  std::size_t known = 0;                                 // points with a known E
  double median = 0, mean = 0, greatest = 0, least = 0;  // of E / E_known - 1
};

using KnownLevel = std::function<std::optional<double>(const Vec3&)>;

Row measure(const core::Mesh& mesh, double spacing, const std::string& directions, const KnownLevel& level,
            unsigned threads) {
  const Job job = compute(mesh, {spacing, directions, core::FrameKind::kAxis, threads});
  const Cloud points = all_points(job);
  std::vector<double> errors;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (const auto known = level(points.place[p])) {
      errors.push_back(points.erosion[p] / (*known * job.solid.volume) - 1);
    }
  }
  std::sort(errors.begin(), errors.end());
  Row row{directions, job.directions.size(), errors.size(), 0, 0, 0, 0};
  row.median = errors[errors.size() / 2];
  row.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  row.greatest = errors.back();
  row.least = errors.front();
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

// The slope of log(median error) against log(N), by the first and the last row.
double slope(const std::vector<Row>& rows) {
  return std::log(rows.back().median / rows.front().median) /
         std::log(static_cast<double>(rows.back().count) / static_cast<double>(rows.front().count));
}

struct Measured {
  Row triangles;            // the mesh's own directions
  std::vector<Row> sphere;  // those of spheres, ever finer
  Row both;                 // the mesh's own and those of the finest sphere
};

Measured measure_all(const Subject& subject, const std::vector<int>& counts, unsigned threads) {
  const auto with = [&](const std::string& directions) {
    return measure(subject.mesh, subject.spacing, directions, subject.level, threads);
  };
  Measured measured{with("triangles"), {}, with("triangles+sphere:" + std::to_string(counts.back()))};
  for (const int count : counts) measured.sphere.push_back(with("sphere:" + std::to_string(count)));
  return measured;
}

void add_rows(const std::string& solid, const Measured& measured, Table& table, Report& report) {
  std::vector<Row> rows = {measured.triangles};
  rows.insert(rows.end(), measured.sphere.begin(), measured.sphere.end());
  rows.push_back(measured.both);
  for (const Row& row : rows) {
    table.rows.push_back({solid, row.directions, std::to_string(row.count), std::to_string(row.known),
                          format("%.3g %%", 100 * row.median), format("%.3g %%", 100 * row.mean),
                          format("%.3g %%", 100 * row.greatest)});
    report.expect(solid + ", " + row.directions + ": least error of E", row.least, -1e-9, 100);
  }
}

void add_lines(const Subject& subject, const Measured& measured, Chart& chart) {
  Line median{subject.name + ", median", subject.colour, false, true, {}};
  Line mean{subject.name + ", mean", subject.colour, true, true, {}};
  for (const Row& row : measured.sphere) {
    const auto n = static_cast<double>(row.count);
    median.points.push_back({n, 100 * row.median});
    mean.points.push_back({n, 100 * row.mean});
  }
  const double own = 100 * measured.triangles.median;
  chart.lines.push_back(median);
  chart.lines.push_back(mean);
  chart.lines.push_back(
      {subject.name + ", triangles, median", subject.colour, true, false, {{50, own}, {5e4, own}}});
}

constexpr const char* kText =
    "Published: the method cannot cope with a cube or a tetrahedron, whose triangles have six and four "
    "normals; proposed, but not tried, is a triangulated sphere round the object whose normals are taken "
    "instead. It works. Points: those of a lattice where E has a closed form, 4.5 abc for distances a, b, "
    "c (in edges, each at most 1/3) from three faces of a cube, 27 v0 times the product of the three "
    "least barycentric coordinates (each at most 1/3) in a tetrahedron. A finite set can only "
    "overestimate E. The median error falls like 1/N: E is a minimum over directions, flat to first order "
    "there, and the nearest of N directions is about N^(-1/2) away. The mean falls more slowly in the "
    "tetrahedron, and the greatest error hardly: close to an edge or a corner the best plane is nearly "
    "parallel to a face, and the chord grows fast with the angle between that plane and the nearest one "
    "of an even set. A union with the mesh's own normals helps there.";

}  // namespace

void plane_experiment(const Setting& setting, Report& report) {
  const std::vector<int> counts =
      setting.quick ? std::vector<int>{80, 320, 1280} : std::vector<int>{80, 320, 1280, 5120, 20480};
  Table table{
      {"solid", "directions", "their number", "points with known E", "median error", "mean", "greatest"}, {}};
  Chart chart;
  chart.title = "Error of E at points where it is known, directions sphere:N";
  chart.x = {"directions N", 50, 50000, true};
  chart.y = {"relative error of E, %", 0.001, 1000, true};
  std::string here;
  for (const Subject& subject : subjects()) {
    const Measured measured = measure_all(subject, counts, setting.threads);
    add_rows(subject.name, measured, table, report);
    add_lines(subject, measured, chart);
    const double exponent = slope(measured.sphere);
    here += (here.empty() ? "" : "; ") + subject.name +
            format(": median error %.0f %% with triangles, %.2g %% with %zu directions, as N^%.2f",
                   100 * measured.triangles.median, 100 * measured.sphere.back().median,
                   measured.sphere.back().count, exponent);
    report.expect(subject.name + ": exponent of the median error", exponent, -1.5, -0.6);
  }
  report.section("Directions of the planes (6.5.1, figure 6.22)");
  report.table(table);
  report.drawing("planes", svg_of(chart), "Error of E against the number of directions");
  report.text(kText);
  report.compare({"cube and tetrahedron, directions of a sphere", "proposed, not tried", here,
                  "works; slow near edges and corners"});
}

}  // namespace affskel::experiments
