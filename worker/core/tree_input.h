#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/join_tree.h"
#include "core/ray_shooter.h"
#include "core/solid.h"

namespace affskel::core {

/// What TreeInput holds; for the sources of the join tree only.
struct TreeInput::Data {
  Data(const Solid& solid, unsigned threads);

  /// Triangles round a vertex.
  std::span<const std::uint32_t> fan(std::uint32_t vertex) const {
    return {fan_triangles.data() + fan_begin[vertex], fan_begin[vertex + 1] - fan_begin[vertex]};
  }

  const Solid& solid;
  std::vector<Vec3> area_vector;         ///< per triangle: outward normal times area, inner units
  std::vector<Vec3> pseudonormal;        ///< per vertex: unit normals weighted by the angles they span
  std::vector<std::uint32_t> fan_begin;  ///< per vertex and one more
  std::vector<std::uint32_t> fan_triangles;
  std::vector<std::uint32_t> vertex_solid;  ///< per vertex: the solid its surface bounds
  std::vector<double> solid_volume;         ///< inner units
  double volume = 0;                        ///< all solids, inner units
  double surface_area = 0;                  ///< inner units
  RayShooter rays;
};

}  // namespace affskel::core
