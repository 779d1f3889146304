#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/groups.h"
#include "core/base/none.h"
#include "core/infimum/crossing_pairs.h"
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
/// Vertices and triangles are numbered anew, so that neighbours are near in memory.  Each shell has a spanning
/// tree of its vertices, the shortest; in its preorder those below one are an interval.  A set of vertices that is connected in the
/// tree is a difference of such intervals, so that its sums are known from the tree edges that leave it.
struct PieceInput {
  struct Shell {
    std::uint32_t root = 0;   ///< its first vertex
    std::uint32_t solid = 0;  ///< the solid it bounds; the least one of those that pass through each other
    /// Two edges for every handle: with them the tree's edges cut the shell into a disc (tree-cotree, Eppstein
    /// 2003).
    std::vector<Segment> handles;
  };

  explicit PieceInput(const Solid& solid, unsigned threads = 1);

  std::uint32_t begin_of(std::uint32_t half_edge) const {
    return mesh.triangles[half_edge / 3][half_edge % 3];
  }
  std::uint32_t end_of(std::uint32_t half_edge) const {
    return mesh.triangles[half_edge / 3][(half_edge + 1) % 3];
  }
  PieceInput(const PieceInput&) = delete;
  PieceInput& operator=(const PieceInput&) = delete;

  /// Of a vertex: itself and those below it in the tree, in preorder.
  struct Branch {
    std::uint32_t first = 0, count = 0;
    std::uint32_t end() const { return first + count; }
    bool holds(const Branch& other) const { return other.first - first < count; }
  };

  struct Face {
    Vec3 area;  ///< outward
    SurfaceSums sums;
  };

  /// How the rim of a section goes on where it passes a half-edge, which rises from below the plane, into the
  /// triangle beyond.
  struct Passage {
    std::uint32_t apex = 0;        ///< the corner that is not on the edge
    std::uint32_t when_above = 0;  ///< the half-edge that it leaves by when the apex is above the plane
    std::uint32_t when_below = 0;
    std::uint32_t edge = kNone;  ///< its number among `edges`
  };

  Mesh mesh;                      ///< the solid's, numbered anew
  std::vector<Passage> passages;  ///< per half-edge 3 t + i
  std::vector<Face> faces;        ///< per triangle
  std::vector<Branch> branches;   ///< per vertex
  /// Per vertex: sums over the triangles whose first corner is below it in the tree, or is the vertex itself.
  std::vector<SurfaceSums> below;
  struct Edge {
    std::uint32_t begin = 0, end = 0;           ///< vertices
    std::uint32_t there = kNone, back = kNone;  ///< its half-edges; of a root none
  };

  /// Those from a vertex to its parent, by vertices; then those of Shell::handles.
  std::vector<Edge> edges;
  std::vector<std::uint32_t> shell_of;  ///< per vertex
  std::vector<Shell> shells;
  FourTree edge_tree;  ///< over `edges`; a root is by itself
  /// A vertex at which parts of a piece may meet: where neither the solid is convex nor the outside.
  struct Saddle {
    std::uint32_t vertex = 0;
    Vec3 normal;  ///< of the surface there, unit
    /// The normals of all planes at which parts meet make no less with it, or its opposite.
    double cosine = 0;
    double sine = 1;  ///< of the same angle
  };
  std::vector<Saddle> saddles;  ///< by vertex
  FourTree saddle_tree;         ///< over `saddles`
  Groups<std::uint32_t> rings;  ///< per vertex: its neighbours, in their order round it
  CrossingPairs crossings;
  bool is_ball = false;            ///< one shell without handles that does not pass through itself
  double volume = 0;               ///< of all solids, scaled units
  std::optional<RayShooter> rays;  ///< only where a solid has several shells

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> number_anew(const Solid& solid);
  void join_solids(const Solid& solid);
  void plant_trees();
  void sum_up();
  void find_handles();
  void find_passages();
  void find_rings();
  void find_saddles();
  bool is_convex(std::uint32_t vertex) const;
  Saddle saddle_at(std::uint32_t vertex) const;

  std::vector<std::uint32_t> mates_;   // per half-edge; until the others are made
  std::vector<std::uint32_t> parent_;  // per vertex, of a root itself; likewise
};

}  // namespace affskel::core
