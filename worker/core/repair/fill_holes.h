#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Time grows with the square of a loop's edges: two of so many take 18 s.
inline constexpr std::uint64_t kMaxHoleEdges = 20'000;

struct FillHolesOptions {
  double longest = 0;                   ///< boundary loops up to this length are filled, mesh units
  ExecutionContext* context = nullptr;  ///< asked within holes, too, whether to stop
};

/// A boundary loop.
struct Hole {
  std::uint64_t edges = 0;
  double length = 0;        ///< mesh units
  Vec3 centre;              ///< of its points
  std::uint32_t point = 0;  ///< one of them
  bool filled = false;
  double area = 0;   ///< of what fills it, mesh units squared
  double bulge = 0;  ///< volume between it and a soap film in the same rim, mesh units cubed
};

struct FilledHoles {
  Mesh mesh;                ///< the given points first, as they were
  std::vector<Hole> holes;  ///< longest first
};

/// Fills holes by CGAL: a plane loop by a plane cut, any other by the triangulation of least area and bending that is
/// refined to the density of its rim and faired (Liepa 2003; Zou, Ju & Carr 2013).  Loops of more than kMaxHoleEdges, and
/// those that nothing fills, are left.
/// @param mesh manifold, its triangles agreeing.
/// @throws CoreError kCancelled when the context asks to stop.
FilledHoles fill_holes(const Mesh& mesh, const FillHolesOptions& options);

/// The boundary loops of triangles in any state, longest first, after what orient_soup does to them.
/// @throws CoreError kBadInput when no triangle has three different corners.
std::vector<Hole> find_holes(const Mesh& mesh);

}  // namespace affskel::core
