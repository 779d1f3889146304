#include "core/body.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/body_shape.h"
#include "core/edge_collapse.h"
#include "core/error.h"
#include "core/implicit_mesh.h"
#include "core/number_text.h"
#include "core/self_intersection.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kLeast = 200, kMost = 200000;

void check(const MakeBodyOptions& options) {
  if (options.triangles < kLeast || options.triangles > kMost || options.triangles % 2 != 0) {
    throw CoreError(CoreError::Code::kBadInput, "body: the number of triangles must be even and within " +
                                                    std::to_string(kLeast) + " .. " + std::to_string(kMost) +
                                                    ", not " + std::to_string(options.triangles));
  }
  if (!(std::isfinite(options.height) && options.height > 0)) {
    throw CoreError(CoreError::Code::kBadInput,
                    "body: the height must be a finite number > 0, not " + to_text(options.height));
  }
}

/// The body with at least `triangles` triangles, nearly equilateral and of equal size.
Mesh fine_body(double triangles) {
  // Measured: the body has kPerSquare / spacing^2 triangles.
  constexpr double kPerSquare = 9.0e6;
  const double spacing = std::sqrt(kPerSquare / triangles);
  Mesh mesh = mesh_zero_set(body_function, {kBodyLow, kBodyHigh, spacing});
  fair_onto(body_function, 0.05, 4, mesh);
  return mesh;
}

/// Moves the soles to z = 0 and scales the whole to the height.
void scale_to_height(double height, Mesh& mesh) {
  const auto [low, high] = std::minmax_element(mesh.points.begin(), mesh.points.end(),
                                               [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  const double sole = low->z, scale = height / (high->z - low->z);
  for (Vec3& p : mesh.points) p = {scale * p.x, scale * p.y, scale * (p.z - sole)};
}

}  // namespace

Mesh make_body(const MakeBodyOptions& options) {
  check(options);
  double fine = std::max(60000.0, 2.2 * options.triangles);
  constexpr int kAttempts = 8;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Mesh mesh = collapse_edges(fine_body(fine), options.triangles);
    if (mesh.triangles.size() == options.triangles && self_intersections(mesh, {.max_pairs = 1}).empty()) {
      scale_to_height(options.height, mesh);
      return mesh;
    }
    fine *= 1.07;  // another lattice, another order of collapses
  }
  throw CoreError(CoreError::Code::kInternal, "body: no reduction to " + std::to_string(options.triangles) +
                                                  " triangles came out free of self-intersections");
}

}  // namespace affskel::core
