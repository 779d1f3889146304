#include "core/voxels/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/mesh/box.h"
#include "core/mesh/map_mesh.h"
#include "core/shapes/edge_collapse.h"
#include "core/voxels/sign_surface.h"

namespace affskel::core {
namespace {

constexpr double kCellsAlongTheSolid = 200;
// More triangles before edges are collapsed add nothing to what is left, but take memory: a share of those wanted.
constexpr double kTrianglesBefore = 8;
// Triangles that a cube's edge squared of the surface gets, as measured on balls and bodies, per side of a voxel between
// both sides, of which there are 1.5 times the surface's area on average over its slopes.
constexpr double kTrianglesPerSide = 4;

// The image with voxels around it that lie outside of the solid, as a function of indices: negative within.
class Inside {
 public:
  Inside(const VoxelImage& image, double isovalue) : image_(image), isovalue_(isovalue) {
    const auto [low, high] = value_range(image);
    if (!(low <= isovalue && isovalue < high)) {
      refuse("has no surface at the value " + base::to_text(isovalue) + ": its values run from " +
             base::to_text(low) + " to " + base::to_text(high));
    }
    below_ = most_of_the_border_is_above();
    outside_ = below_ ? high : low;
    for_each_voxel([&](std::size_t i, std::size_t j, std::size_t k, double value) {
      const bool inside = is_inner(value);
      for (const double next : {voxel(i + 1, j, k), voxel(i, j + 1, k), voxel(i, j, k + 1)})
        if (is_inner(next) != inside) ++sides_;
      if (inside) reach_.include(vector_of(std::array{i, j, k}));
    });
    if (reach_.high[0] < 0) refuse("has no voxel on the inner side of " + base::to_text(isovalue));
  }

  double operator()(const Vec3& p) const {
    const double x = std::floor(p.x), y = std::floor(p.y), z = std::floor(p.z);
    const double u = p.x - x, v = p.y - y, w = p.z - z;
    double value = 0;  // of differences, so that it has the sign of voxels that have one
    for (int corner = 0; corner < 8; ++corner) {
      const bool a = (corner & 1) != 0, b = (corner & 2) != 0, c = (corner & 4) != 0;
      const double weight = (a ? u : 1 - u) * (b ? v : 1 - v) * (c ? w : 1 - w);
      if (weight > 0) value += weight * (voxel_at(x + a, y + b, z + c) - isovalue_);
    }
    return below_ ? value : -value;
  }

  bool below() const { return below_; }
  // Of voxels, between both sides of the surface.
  std::size_t sides() const { return sides_; }
  // Of the inner voxels, indices.
  const Box& reach() const { return reach_; }
  bool reaches_border() const {
    bool reaches = false;
    for (std::size_t a = 0; a < 3; ++a)
      reaches |= reach_.low[a] == 0 || reach_.high[a] == static_cast<double>(image_.size[a] - 1);
    return reaches;
  }

 private:
  // A voxel of the value itself lies outside, as the function is negative within alone.
  bool is_inner(double value) const { return below_ ? value < isovalue_ : value > isovalue_; }
  // Behind the last voxels lies the outside.
  double voxel(std::size_t i, std::size_t j, std::size_t k) const {
    return i < image_.size[0] && j < image_.size[1] && k < image_.size[2] ? image_.at(i, j, k) : outside_;
  }
  double voxel_at(double i, double j, double k) const {
    if (i < 0 || j < 0 || k < 0 || !(i < static_cast<double>(image_.size[0])) ||
        !(j < static_cast<double>(image_.size[1])) || !(k < static_cast<double>(image_.size[2])))
      return outside_;
    return image_.at(static_cast<std::size_t>(i), static_cast<std::size_t>(j), static_cast<std::size_t>(k));
  }
  bool on_border(std::size_t i, std::size_t j, std::size_t k) const {
    return i == 0 || j == 0 || k == 0 || i + 1 == image_.size[0] || j + 1 == image_.size[1] ||
           k + 1 == image_.size[2];
  }
  template <class Body>
  void for_each_voxel(const Body& body) const {
    std::size_t voxel = 0;
    for (std::size_t k = 0; k < image_.size[2]; ++k)
      for (std::size_t j = 0; j < image_.size[1]; ++j)
        for (std::size_t i = 0; i < image_.size[0]; ++i) body(i, j, k, image_.value(voxel++));
  }
  bool most_of_the_border_is_above() const {
    std::int64_t above = 0;
    for_each_voxel([&](std::size_t i, std::size_t j, std::size_t k, double value) {
      if (on_border(i, j, k)) above += value > isovalue_ ? 1 : -1;
    });
    return above > 0;
  }

  const VoxelImage& image_;
  double isovalue_;
  bool below_ = false;
  double outside_ = 0;
  std::size_t sides_ = 0;
  Box reach_;
};

}  // namespace

std::pair<double, double> value_range(const VoxelImage& image) {
  double low = image.value(0), high = low;
  for (std::size_t i = 1; i < image.size[0] * image.size[1] * image.size[2]; ++i) {
    low = std::min(low, image.value(i));
    high = std::max(high, image.value(i));
  }
  return {low, high};
}

Isosurface isosurface(const VoxelImage& image, const IsosurfaceOptions& options) {
  const Inside inside(image, options.isovalue);
  Isosurface found;
  found.below = inside.below();
  found.cut = inside.reaches_border();
  const double longest = inside.reach().longest_side() + 1;
  const double enough = std::sqrt(kTrianglesPerSide * static_cast<double>(inside.sides()) /
                                  (kTrianglesBefore * static_cast<double>(options.max_triangles)));
  found.resolution = std::max({1.0, longest / kCellsAlongTheSolid, enough});
  // The outermost nodes are a voxel beside the inner ones, or farther; at a resolution of 1 all are voxels.
  CubeLattice lattice{inside.reach().low - Vec3{1, 1, 1}, found.resolution, {}};
  for (std::size_t a = 0; a < 3; ++a)
    lattice.nodes[a] =
        static_cast<std::size_t>(std::ceil((inside.reach().sides()[a] + 2) / found.resolution)) + 1;
  found.mesh = sign_surface(inside, lattice, options.context);
  if (found.mesh.triangles.size() > options.max_triangles) {
    // collapse_edges works on meshes in x > 0.
    const Vec3 shift{1 - lattice.low.x, 0, 0};
    for (Vec3& p : found.mesh.points) p = p + shift;
    found.mesh =
        collapse_edges(found.mesh, options.max_triangles, options.context, SelfCrossings::kNoNewOnes);
    for (Vec3& p : found.mesh.points) p = p - shift;
  }
  found.mesh = map_mesh(image.place, found.mesh);
  return found;
}

}  // namespace affskel::core
