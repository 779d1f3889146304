#include "core/shapes/body.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/shapes/body_shape.h"
#include "core/shapes/edge_collapse.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/mirror.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kMinBodyTriangles = 200, kMaxBodyTriangles = 200000;

void check(const MakeBodyOptions& options) {
  if (options.triangles < kMinBodyTriangles || options.triangles > kMaxBodyTriangles ||
      options.triangles % 2 != 0) {
    refuse("body: the number of triangles must be even and within " + std::to_string(kMinBodyTriangles) +
           " .. " + std::to_string(kMaxBodyTriangles) + ", not " + std::to_string(options.triangles));
  }
  if (!(std::isfinite(options.height) && options.height > 0)) {
    refuse("body: the height must be a finite number > 0, not " + base::to_text(options.height));
  }
}

/// The right half (x >= 0) of the body with about `triangles` triangles, nearly equilateral and of equal
/// size but for those cut at the plane of symmetry, where it is open.
Mesh fine_half(double triangles) {
  // Measured: the half has kPerSquare / spacing^2 triangles.
  constexpr double kPerSquare = 1.19e7;
  const double spacing = std::sqrt(kPerSquare / triangles);
  const Vec3 low{-4 * spacing, kBodyLow.y, kBodyLow.z};
  Mesh mesh = mesh_zero_set(body_function, {low, kBodyHigh, spacing});
  fair_onto(body_function, 0.05, 4, mesh);
  return positive_x_half(mesh, 0.15 * spacing);
}

constexpr double kFewestFine = 45000;

/// Smaller bodies are all reduced from it: a quarter of the time that one takes is saved for the next.
const Mesh& usual_fine_half() {
  static const Mesh half = fine_half(kFewestFine);
  return half;
}

/// Takes a reduced body to its height.  The vertices of a coarse mesh stand out of the surface they stand
/// for (that keeps the volume): those near the ground are moved onto it first, so that the soles stay flat;
/// the crown is let in by a height that the whole body shares.
void scale_to_height(double height, Mesh& mesh) {
  constexpr double kGround = 4;  // mm
  double high = 0;
  for (Vec3& p : mesh.points) {
    if (p.z < kGround) p.z = 0;
    high = std::max(high, p.z);
  }
  const double scale = height / kBodyHeight, upright = height / high;
  for (Vec3& p : mesh.points) p = {scale * p.x, scale * p.y, upright * p.z};
}

}  // namespace

Mesh make_body(const MakeBodyOptions& options) {
  check(options);
  double fine = std::max(kFewestFine, 1.1 * options.triangles);
  constexpr int kAttempts = 8;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Mesh half =
        collapse_edges(fine == kFewestFine ? usual_fine_half() : fine_half(fine), options.triangles / 2);
    Mesh mesh = with_mirror_image(half);
    scale_to_height(options.height, mesh);
    if (mesh.triangles.size() == options.triangles && self_intersections(mesh, {.max_pairs = 1}).empty()) {
      return mesh;
    }
    fine *= 1.07;  // another lattice, another order of collapses
  }
  throw CoreError(CoreError::Code::kInternal, "body: no reduction to " + std::to_string(options.triangles) +
                                                  " triangles came out free of self-intersections");
}

}  // namespace affskel::core
