#pragma once

#include <cstddef>
#include <utility>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"
#include "core/voxels/voxel_image.h"

namespace affskel::core {

struct IsosurfaceOptions {
  double isovalue = 0;                  ///< at the surface
  std::size_t max_triangles = 20000;    ///< of a finer surface edges are collapsed (collapse_edges)
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

struct Isosurface {
  Mesh mesh;           ///< closed, manifold, outward; in the units of the image's places
  bool below = false;  ///< whether the solid is where values are below the isovalue
  bool cut = false;    ///< whether the solid reaches the image's border, where it is closed
  /// Edge of the cubes that the surface is sought in, voxels: a 200th of the longest side of the solid's box, but no less
  /// than one, nor than gives eight times max_triangles.
  double resolution = 0;
};

/// The least and the greatest value.
std::pair<double, double> value_range(const VoxelImage& image);

/// The surface at which the image, interpolated linearly along each axis between the voxels' places, has a value.
/// The solid is the side that most of the image's outermost voxels are not on, without voxels of the value itself; where
/// it reaches them it ends within a voxel behind.  At a resolution of 1 the voxels alone decide its topology, and each is
/// on the side that its value says as long as no edges are collapsed; at a coarser one, values at places so far apart
/// (sign_surface).  It does not cross itself.
/// @throws CoreError kBadInput when the image has no such value, or one side has no voxel, kCancelled.
Isosurface isosurface(const VoxelImage& image, const IsosurfaceOptions& options);

}  // namespace affskel::core
