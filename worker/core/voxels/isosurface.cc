#include "core/voxels/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/mesh/box.h"
#include "core/mesh/map_mesh.h"
#include "core/shapes/edge_collapse.h"
#include "core/shapes/implicit_mesh.h"

namespace affskel::core {
namespace {

constexpr double kCellsAlongTheSolid = 200;
constexpr int kFairingRounds = 3;
constexpr double kMaxCubes = 16777216;
constexpr std::uint64_t kOperations = 20;  // to find a value between voxels, some nanoseconds each
// More triangles before edges are collapsed add nothing to what is left, but take memory: a share of those wanted.
constexpr double kTrianglesBefore = 8;
// Triangles that a cube's edge squared of the surface gets, as measured on balls and bodies, per side of a voxel between
// both sides, of which there are 1.5 times the surface's area on average over its slopes.
constexpr double kTrianglesPerSide = 6;

// How far the surface is at least, by blocks of voxels: a block spans its voxels and the way to the next ones, and those
// with both sides in them hold the whole surface.
class Clearance {
 public:
  // @param is_inside of a voxel; behind the last ones is none.
  template <class IsInside>
  Clearance(const std::array<std::size_t, 3>& size, const IsInside& is_inside) {
    for (std::size_t a = 0; a < 3; ++a) blocks_[a] = size[a] / kBlock + 1;
    away_.assign(blocks_[0] * blocks_[1] * blocks_[2], kFar);
    for_each_block([&](std::size_t i, std::size_t j, std::size_t k, std::uint8_t& away) {
      bool some = false, all = true;
      for (std::size_t z = k * kBlock; z <= (k + 1) * kBlock; ++z)
        for (std::size_t y = j * kBlock; y <= (j + 1) * kBlock; ++y)
          for (std::size_t x = i * kBlock; x <= (i + 1) * kBlock; ++x)
            (is_inside(x, y, z) ? some : all) = is_inside(x, y, z);
      const bool before_first = (i == 0 || j == 0 || k == 0) && some;
      if ((some && !all) || before_first) away = 0;
    });
    for (std::size_t axis = 0; axis < 3; ++axis) spread_along(axis);
  }

  // From a place, voxels.
  double at(const Vec3& p) const {
    const auto block = [&](double at, std::size_t axis) {
      const double b = std::floor(at / kBlock);
      return static_cast<std::size_t>(std::clamp(b, 0.0, static_cast<double>(blocks_[axis] - 1)));
    };
    const std::uint8_t away = away_[index(block(p.x, 0), block(p.y, 1), block(p.z, 2))];
    return away < 2 ? 0 : (away - 1.0) * kBlock;
  }

 private:
  static constexpr std::size_t kBlock = 4;
  static constexpr std::uint8_t kFar = 255;

  std::size_t index(std::size_t i, std::size_t j, std::size_t k) const {
    return (k * blocks_[1] + j) * blocks_[0] + i;
  }
  template <class Body>
  void for_each_block(const Body& body) {
    for (std::size_t k = 0; k < blocks_[2]; ++k)
      for (std::size_t j = 0; j < blocks_[1]; ++j)
        for (std::size_t i = 0; i < blocks_[0]; ++i) body(i, j, k, away_[index(i, j, k)]);
  }
  // The least, over the line, of the greater of the way along it and what is known there: after all axes the greatest
  // of the three ways, blocks.
  void spread_along(std::size_t axis) {
    const std::size_t step = axis == 0 ? 1 : axis == 1 ? blocks_[0] : blocks_[0] * blocks_[1];
    std::vector<std::uint8_t> line(blocks_[axis]);
    for_each_block([&](std::size_t i, std::size_t j, std::size_t k, std::uint8_t& first) {
      if (std::array{i, j, k}[axis] != 0) return;
      for (std::size_t n = 0; n < line.size(); ++n) line[n] = (&first)[n * step];
      for (std::size_t n = 0; n < line.size(); ++n) {
        std::size_t least = line[n];
        for (std::size_t way = 1; way < least; ++way) {
          if (n >= way) least = std::min(least, std::max<std::size_t>(way, line[n - way]));
          if (n + way < line.size()) least = std::min(least, std::max<std::size_t>(way, line[n + way]));
        }
        (&first)[n * step] = static_cast<std::uint8_t>(least);
      }
    });
  }

  std::array<std::size_t, 3> blocks_{};
  std::vector<std::uint8_t> away_;  // per block: blocks to the nearest that holds a part of the surface
};

// The image with a layer of voxels around it that lie outside of the solid, as a function of indices: negative within,
// and scaled so that it falls by no more than 1 per voxel; far from the surface, where masks have the same value
// everywhere, at least as large as the surface is away, so that no cubes are looked at there.
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
      steepest_ = std::max({steepest_, std::abs(value - voxel(i + 1, j, k)),
                            std::abs(value - voxel(i, j + 1, k)), std::abs(value - voxel(i, j, k + 1)),
                            on_border(i, j, k) ? std::abs(value - outside_) : 0.0});
      const bool inside = is_inner(value);
      for (const double next : {voxel(i + 1, j, k), voxel(i, j + 1, k), voxel(i, j, k + 1)})
        if (is_inner(next) != inside) ++sides_;
      if (inside) reach_.include(vector_of(std::array{i, j, k}));
    });
    if (reach_.high[0] < 0) refuse("has no voxel on the inner side of " + base::to_text(isovalue));
    steepest_ *= std::sqrt(3.0);  // the slope along each axis at once
    clearance_ = std::make_shared<const Clearance>(
        image.size, [&](std::size_t i, std::size_t j, std::size_t k) { return is_inner(voxel(i, j, k)); });
  }

  double operator()(const Vec3& p) const {
    const double x = std::floor(p.x), y = std::floor(p.y), z = std::floor(p.z);
    const double u = p.x - x, v = p.y - y, w = p.z - z;
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const bool a = (corner & 1) != 0, b = (corner & 2) != 0, c = (corner & 4) != 0;
      value += (a ? u : 1 - u) * (b ? v : 1 - v) * (c ? w : 1 - w) * voxel_at(x + a, y + b, z + c);
    }
    const double fallen = (below_ ? value - isovalue_ : isovalue_ - value) / steepest_;
    return std::copysign(std::max(std::abs(fallen), clearance_->at(p)), fallen);
  }

  bool below() const { return below_; }
  // Of voxels, between both sides of the surface.
  std::size_t sides() const { return sides_; }
  // Of the inner voxels, indices.
  const Box& reach() const { return reach_; }

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
  double steepest_ = 0;
  std::size_t sides_ = 0;
  Box reach_;  // of the inner voxels, indices
  std::shared_ptr<const Clearance> clearance_;
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
  const double longest = inside.reach().longest_side() + 1;
  const double enough = std::sqrt(kTrianglesPerSide * static_cast<double>(inside.sides()) /
                                  (kTrianglesBefore * static_cast<double>(options.max_triangles)));
  found.resolution =
      options.resolution > 0 ? options.resolution : std::max({1.0, longest / kCellsAlongTheSolid, enough});
  const double margin = 1 + 1.5 * found.resolution;
  ImplicitMeshOptions cubes;
  cubes.low = inside.reach().low - Vec3{margin, margin, margin};
  cubes.high = inside.reach().high + Vec3{margin, margin, margin};
  cubes.spacing = found.resolution;
  const Vec3 box = cubes.high - cubes.low;
  if (box.x / cubes.spacing * (box.y / cubes.spacing) * (box.z / cubes.spacing) > kMaxCubes)
    throw CoreError(CoreError::Code::kLimit, "the resolution is too fine for so large an image");
  StopCheck stop(options.context);
  const ImplicitFunction asked = [&](const Vec3& p) {
    stop.did(kOperations);
    return inside(p);
  };
  found.mesh = mesh_zero_set(asked, cubes);
  fair_onto(asked, 0.25 * found.resolution, kFairingRounds, found.mesh, found.resolution);
  if (found.mesh.triangles.size() > options.max_triangles) {
    // collapse_edges works on meshes in x > 0.
    const Vec3 shift{1 - cubes.low.x, 0, 0};
    for (Vec3& p : found.mesh.points) p = p + shift;
    found.mesh = collapse_edges(found.mesh, options.max_triangles, options.context);
    for (Vec3& p : found.mesh.points) p = p - shift;
  }
  found.mesh = map_mesh(image.place, found.mesh);
  return found;
}

}  // namespace affskel::core
