#include "client/comparison/comparison.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "base/number_text.h"
#include "client/base/error.h"
#include "core/base/error.h"
#include "core/mesh/box.h"
#include "core/quality/interior_points.h"
#include "core/solid/surface_samples.h"

namespace affskel::client {
namespace {

// Squares and fourth powers of lengths must stay well inside the range of a double: squared radii are
// printed, areas of triangles summed.
constexpr double kMinLength = 1e-150, kMaxLength = 1e150;
constexpr double kMinSurface = 1e-60, kMaxSurface = 1e60;
constexpr const char* kScaleFirst = "; scale the files first";

double longest_side(std::initializer_list<const std::vector<core::Vec3>*> sets) {
  core::Box box;
  for (const std::vector<core::Vec3>* set : sets) box.include(core::box_of(*set));
  return box.longest_side();
}

void check_surface_size(const core::Mesh& mesh, const std::string& path) {
  const double side = longest_side({&mesh.points});
  if (side == 0 || (side >= kMinSurface && side <= kMaxSurface)) return;
  throw ClientError(ExitCode::kBadInput,
                    "a surface of size " + base::rounded(side, 3) +
                        "; those from 1e-60 to 1e60 can be compared" + kScaleFirst,
                    path);
}

// Points spread over the triangles, and along the curves at the same distances, as many again at most.
// @return their distances.
double spread_points(const ShapeFile& shape, std::uint64_t samples, std::vector<core::Vec3>& points) {
  const core::Mesh& mesh = shape.mesh();
  const double length = core::curve_length(mesh.points, shape.segments);
  double distance = length / static_cast<double>(samples);
  if (!mesh.triangles.empty()) {
    points = core::surface_samples(mesh, samples);
    distance = std::sqrt(core::surface_area(mesh) / static_cast<double>(points.size()));
  }
  if (shape.segments.empty() || length == 0) return distance;
  const double wanted = std::clamp(std::ceil(length / distance), 1.0, static_cast<double>(samples));
  const std::vector<core::Vec3> more =
      core::curve_samples(mesh.points, shape.segments, static_cast<std::size_t>(wanted));
  points.insert(points.end(), more.begin(), more.end());
  return distance;
}

ComparedPoints read_points(const std::string& file, std::uint64_t samples, const FileWork& work,
                           Notices& notices) {
  ShapeFile shape = work.read(file);
  const std::string path = shape.path;
  ComparedPoints result{path, shape.is_surface(), {}};
  if (!shape.is_surface()) {
    result.points = std::move(shape.off.mesh.points);
  } else {
    check_surface_size(shape.mesh(), path);
    try {
      const double distance = spread_points(shape, samples, result.points);
      notices.push_back(
          note("SURFACE_SAMPLED",
               (shape.mesh().triangles.empty() ? "lines, compared by " : "a surface, compared by ") +
                   base::counted(result.points.size(), "point") + " spread over it, about " +
                   base::rounded(distance, 3) + " apart",
               path));
    } catch (const core::CoreError& error) {
      throw error_from_core(error, path);
    }
  }
  if (result.points.empty()) {
    throw ClientError(ExitCode::kBadInput,
                      "holds no points; an empty skeleton has no similarity (was its threshold too high?)",
                      path);
  }
  return result;
}

core::Solid read_solid(const std::string& path, const FileWork& work, Notices& notices) {
  InputFile input;
  input.path = path;
  input.off = work.read(path).off;
  if (input.off.mesh.triangles.empty()) {
    throw ClientError(ExitCode::kBadInput, "has no triangles, so it bounds no solid", path);
  }
  core::Solid solid = work.make_solid(input);
  append(notices, solid_notices(solid, input));
  return solid;
}

// sqrt(3) / 128 of the box's longest side: the diagonal of a voxel when 128 of them make the longest side.
double voxel_diagonal(double side) {
  return std::sqrt(3.0) * side / 128;
}

// 0 means none was given.
double plain_radius(double shown, bool squared, const char* name) {
  const double radius = squared ? std::sqrt(shown) : shown;
  if (radius != 0 && !(radius >= kMinLength && radius <= kMaxLength)) {
    throw ClientError(ExitCode::kUsage, std::string(name) + ": a radius must lie within " +
                                            (squared ? "1e-300 to 1e300 (squared)" : "1e-150 to 1e150") +
                                            ", not " + base::to_text(shown));
  }
  return radius;
}

double default_radius(double side) {
  const double radius = voxel_diagonal(side);
  if (radius == 0) {
    throw ClientError(ExitCode::kUsage, "all points lie at one place; give a radius");
  }
  if (radius < kMinLength) {
    throw ClientError(ExitCode::kUsage, "all points lie within " + base::rounded(side, 3) +
                                            ", too near for a radius of their own; give one" +
                                            std::string(", or") + (kScaleFirst + 1));
  }
  return radius;
}

// Longest side of the box round both sets.
double common_side(const ComparedPoints& a, const ComparedPoints& b) {
  const double side = longest_side({&a.points, &b.points});
  if (side > kMaxLength) {
    throw ClientError(ExitCode::kBadInput,
                      "the points of A and B are up to " + base::rounded(side, 3) +
                          " apart; lengths up to 1e150 can be compared" + kScaleFirst,
                      a.file);
  }
  return side;
}

std::vector<core::Vec3> inner_points_of(const core::Solid& solid, const std::string& path) {
  try {
    return core::interior_points(solid);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, path);
  }
}

std::vector<double> listed_radii(const ComparisonOptions& options) {
  std::vector<double> radii = options.radii;
  if (std::any_of(radii.begin(), radii.end(), [](double r) { return !(r >= 0); }))
    throw ClientError(ExitCode::kUsage, "radii: must not be below 0");
  for (double& r : radii) r = plain_radius(r, options.squared, "radii");
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  if (!(radii.back() > 0)) throw ClientError(ExitCode::kUsage, "radii: the largest radius must be > 0");
  return radii;
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

Comparison compare_files(const ComparisonOptions& options, const FileWork& work) {
  Notices notices;
  const std::vector<double> listed = options.radii.empty() ? std::vector<double>() : listed_radii(options);
  double radius = plain_radius(options.radius, options.squared, "radius");
  ComparedPoints a = read_points(options.a, options.samples, work, notices);
  ComparedPoints b = read_points(options.b, options.samples, work, notices);
  const double side = common_side(a, b);
  std::optional<ChanceLevel> chance;
  if (!options.solid.empty()) {
    const core::Solid solid = read_solid(options.solid, work, notices);
    const std::vector<core::Vec3> inner = inner_points_of(solid, options.solid);
    chance =
        ChanceLevel{inner.size(), core::DistanceCurve(inner, a.points), core::DistanceCurve(inner, b.points)};
    if (radius == 0) radius = voxel_diagonal(core::Box{solid.bbox_min, solid.bbox_max}.longest_side());
  }
  if (radius == 0) radius = default_radius(side);
  core::Similarity curves = core::similarity(a.points, b.points);
  return {std::move(a),
          std::move(b),
          std::move(curves),
          std::move(chance),
          radius,
          options.squared,
          listed.empty() ? default_radii(radius, options.squared) : listed,
          std::move(notices)};
}

}  // namespace affskel::client
