#include "client/comparison.h"

#include <algorithm>
#include <cmath>

#include "client/error.h"
#include "client/exporters/numbers.h"
#include "client/importers/shape_file.h"
#include "client/input_file.h"
#include "client/number_list.h"
#include "core/error.h"
#include "core/surface_samples.h"

namespace affskel::client {
namespace {

ComparedPoints read_points(const std::string& path, std::uint64_t samples, Console& console) {
  ShapeFile shape = read_shape(path);
  ComparedPoints result{path, shape.is_surface(), {}};
  if (!shape.is_surface()) {
    result.points = std::move(shape.off.mesh.points);
  } else {
    try {
      result.points = core::surface_samples(shape.mesh(), {samples});
    } catch (const core::CoreError& error) {
      throw error_from_core(error, path);
    }
    const double spacing =
        std::sqrt(core::surface_area(shape.mesh()) / static_cast<double>(result.points.size()));
    console.note(path + ": a surface, compared by " + std::to_string(result.points.size()) +
                 " points spread over it, about " + rounded(spacing, 3) + " apart");
  }
  if (result.points.empty()) {
    throw ClientError(ExitCode::kBadInput,
                      "holds no points; an empty skeleton has no similarity (was its threshold too high?)",
                      path);
  }
  return result;
}

core::Solid read_solid(const std::string& path, Console& console) {
  InputFile input;
  input.path = path;
  input.off = read_shape(path).off;
  if (input.off.mesh.triangles.empty()) {
    throw ClientError(ExitCode::kBadInput, "has no triangles, so it bounds no solid", path);
  }
  core::Solid solid = check_solid(input, true);
  tell_notes(solid, input, console);
  return solid;
}

// sqrt(3) / 128 of the box's longest side: the diagonal of a voxel when 128 of them make the longest side.
double voxel_diagonal(const core::Vec3& low, const core::Vec3& high) {
  const core::Vec3 size = high - low;
  return std::sqrt(3.0) * std::max({size.x, size.y, size.z}) / 128;
}

double voxel_diagonal(const ComparedPoints& a, const ComparedPoints& b) {
  core::Vec3 low = a.points.front(), high = low;
  for (const ComparedPoints* set : {&a, &b}) {
    for (const core::Vec3& p : set->points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  return voxel_diagonal(low, high);
}

double plain_radius(double shown, bool squared) {
  return squared ? std::sqrt(shown) : shown;
}

std::vector<double> listed_radii(const CompareOptions& options) {
  std::optional<std::vector<double>> radii = parse_numbers(options.radii);
  if (!radii || std::any_of(radii->begin(), radii->end(), [](double r) { return r < 0; })) {
    throw ClientError(ExitCode::kUsage,
                      "--radii: expected numbers >= 0 separated by commas, not '" + options.radii + "'");
  }
  for (double& r : *radii) r = plain_radius(r, options.squared);
  std::sort(radii->begin(), radii->end());
  radii->erase(std::unique(radii->begin(), radii->end()), radii->end());
  if (!(radii->back() > 0)) throw ClientError(ExitCode::kUsage, "--radii: the largest radius must be > 0");
  return *radii;
}

// From 0 to four times the radius, in even steps of what is shown.
std::vector<double> default_radii(double radius, bool squared) {
  constexpr int kSteps = 16;
  std::vector<double> radii;
  for (int i = 0; i <= kSteps; ++i) {
    radii.push_back(squared ? std::sqrt(i) * radius : 4 * radius * i / kSteps);
  }
  return radii;
}

}  // namespace

Comparison compare_files(const CompareOptions& options, Console& console) {
  const std::vector<double> listed = options.radii.empty() ? std::vector<double>() : listed_radii(options);
  ComparedPoints a = read_points(options.a, options.samples, console);
  ComparedPoints b = read_points(options.b, options.samples, console);
  double radius = plain_radius(options.radius, options.squared);
  std::optional<ChanceLevel> chance;
  if (!options.solid.empty()) {
    const core::Solid solid = read_solid(options.solid, console);
    const std::vector<core::Vec3> inner = core::inner_points(solid);
    chance =
        ChanceLevel{inner.size(), core::DistanceCurve(inner, a.points), core::DistanceCurve(inner, b.points)};
    if (radius == 0) radius = voxel_diagonal(solid.bbox_min, solid.bbox_max);
  }
  if (radius == 0) radius = voxel_diagonal(a, b);
  if (radius == 0) {
    throw ClientError(ExitCode::kUsage, "all points lie at one place; give a radius (--radius)");
  }
  core::Similarity curves = core::similarity(a.points, b.points);
  return {std::move(a),
          std::move(b),
          std::move(curves),
          std::move(chance),
          radius,
          options.squared,
          listed.empty() ? default_radii(radius, options.squared) : listed};
}

}  // namespace affskel::client
