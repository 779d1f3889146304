#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>

#include "core/mesh/mesh.h"

namespace affskel::reference {

/// The piece below the plane is not a manifold: its surface touches itself along an edge in the plane.
class CutRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Chordal volumes by cutting the mesh: an oracle that shares nothing with the core's join trees.
///
/// The volume below the plane is built by CGAL (Polygon_mesh_processing::clip with clip_volume, on the
/// exact-constructions kernel, so that planes through vertices, along edges and through whole faces are cuts
/// like all others), split into its closed surfaces, and every inner surface is given to the outer one
/// that holds it.  All decisions are exact; only the sum of the volume is done in doubles, which is good to
/// about 1e-14 of the volume of the bounding box.
///
/// Slow (milliseconds to tenths of a second per plane) and not for several threads at once.
class ClipOracle {
 public:
  /// @param mesh closed, outward-oriented, not crossing itself; cavities and several solids are welcome.
  /// @throws std::invalid_argument when CGAL does not see a volume in it.
  explicit ClipOracle(const core::Mesh& mesh);
  ~ClipOracle();

  /// chord(x, d): volume, in mesh units cubed, of the connected component that holds x of
  /// {y in V : d.y <= d.x}.  The plane passes through x exactly.  Where pieces touch in single points or
  /// along curves of the plane they count as apart.
  /// @param x a point of the interior of V.
  /// @param d any vector but 0.
  /// @throws CutRefused when the piece's surface touches itself along an edge of the plane;
  ///   std::runtime_error when x does not lie on the lid of exactly one piece.  Both name x and d.
  double chord(const core::Vec3& x, const core::Vec3& d);

  /// Planes cut so far; points of the same plane, asked one after the other, share a cut.
  std::uint64_t cuts() const;

 private:
  class Cutter;
  std::unique_ptr<Cutter> cutter_;
};

}  // namespace affskel::reference
