#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/groups.h"
#include "core/infimum/four_tree.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"
#include "core/spatial/ray_shooter.h"

namespace affskel::core {

/// Sums over triangles of N.p / 3 and N / 3, with N the area vector and p any point of the triangle: what a
/// surface adds to the volume, and how that changes with the origin.  In units of 2^-62, modulo 2^64: adding
/// and taking away is exact, in any order.
struct SurfaceSums {
  std::array<std::uint64_t, 4> value{};

  SurfaceSums& operator+=(const SurfaceSums& other) {
    for (std::size_t i = 0; i < 4; ++i) value[i] += other.value[i];
    return *this;
  }
  SurfaceSums& operator-=(const SurfaceSums& other) {
    for (std::size_t i = 0; i < 4; ++i) value[i] -= other.value[i];
    return *this;
  }

  /// The volume between the surface and the origin x; exact but for the triangles' own rounding.
  double volume_from(const Vec3& x) const;
};

/// What all planes through a solid share, for PieceFinder.  Immutable; threads share it.
///
/// Vertices are numbered in preorder of a spanning tree of each shell: the vertices below one in the tree are
/// [v, end[v]).  A set of vertices that is connected in the tree is a difference of such intervals, so that
/// its sums are known from the tree edges that leave it.
struct PieceInput {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  struct Shell {
    std::uint32_t root = 0;   ///< its first vertex
    std::uint32_t solid = 0;  ///< the solid it bounds; the least one of those that pass through each other
    /// Two for every handle: with them the tree's edges cut the shell into a disc (tree-cotree, Eppstein 2003).
    std::vector<Segment> handles;
  };

  explicit PieceInput(const Solid& solid, unsigned threads = 1);
  PieceInput(const PieceInput&) = delete;
  PieceInput& operator=(const PieceInput&) = delete;

  /// Sums over the triangles whose first corner is below `vertex` in the tree, or is `vertex` itself.
  SurfaceSums below(std::uint32_t vertex) const {
    SurfaceSums sums = before[end[vertex]];
    return sums -= before[vertex];
  }

  Mesh mesh;                            ///< the solid's, numbered anew
  std::vector<std::uint32_t> mates;     ///< per half-edge 3 t + i
  std::vector<Vec3> area_vector;        ///< per triangle, outward
  std::vector<SurfaceSums> own;         ///< per triangle
  std::vector<std::uint32_t> parent;    ///< per vertex; of a root itself
  std::vector<std::uint32_t> end;       ///< per vertex
  std::vector<SurfaceSums> before;      ///< per vertex, and one more: over the triangles of those before it
  std::vector<std::uint32_t> shell_of;  ///< per vertex
  std::vector<Shell> shells;
  std::vector<std::uint8_t> at_handle;  ///< per half-edge: of an edge of Shell::handles; empty without any
  FourTree tree;                        ///< over the triangles, which are numbered in its order
  Groups<std::uint32_t> rings;          ///< per vertex: its neighbours, in their order round it
  std::vector<std::uint32_t> owner;     ///< per vertex: a triangle of its
  /// Pairs of triangles that pass through each other.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings;
  std::vector<std::uint8_t> crosses;  ///< per vertex: at such a triangle; empty where there is none
  double volume = 0;                  ///< of all solids, scaled units
  std::optional<RayShooter> rays;     ///< only where a solid has several shells

 private:
  void number_anew(const Solid& solid);
  void add_crossings(const Solid& solid, const std::vector<std::uint32_t>& triangle_number);
  void sum_up();
  void find_handles();
  void find_rings();
};

}  // namespace affskel::core
