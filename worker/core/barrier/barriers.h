#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/matrix3.h"
#include "core/base/vec3.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// A place of a sheet with the normals of its two sides.
struct SheetPlace {
  Vec3 position;            ///< scaled coordinates
  Vec3 normal_a, normal_b;  ///< of the sides' optimal planes: unit vectors, mesh coordinates
};

struct BarrierOptions {
  /// Directions at which chords are computed: the vertices of the coarsest geodesic sphere that has as many,
  /// 10 f^2 + 2.  12 .. 2^20.  2562 lie 4 degrees apart; their grain leaves barriers of up to about 0.01
  /// where there are none, 10242 leave a quarter of that.
  std::uint32_t directions = 2562;
  /// F: the sphere is even in the coordinates u of x = o + F u.  Chords along F^-T n_u, so that the barriers
  /// are affinely invariant where the frame goes along with the map (see solid_frame).
  Matrix3 frame = kIdentity3;
  unsigned threads = 1;
  /// Bytes for chords, 4 for each place and direction.  Places that find no room wait for the next round, and
  /// each round builds all join trees again.  Beside that: the trees' own (see TreeInput), and 48 per place.
  std::uint64_t memory = std::uint64_t{128} << 20;
  ExecutionContext* context = nullptr;  ///< asked for every direction whether to stop
};

/// How far the two sides of a sheet are apart on the sphere of directions.  With f(d) = chord(p, d), let m_a
/// and m_b be the minima of f below the two normals (steepest descent), and let the pass be the least level
/// at which a path of directions leads from m_a to m_b:
///
///     barrier(p) = pass / max(f(m_a), f(m_b)) - 1
///
/// 0 where the normals only turn fast: one basin has both.  Positive where they jump, a shock in the strict
/// sense; there both minima are E(p), and the barrier is the persistence of the second minimum (Edelsbrunner,
/// Letscher and Zomorodian 2002) as a share of E: a change of f by a share e changes it by 2 e (1 + barrier)
/// to first order.  Beside the shock, where a vertex of a sheet may lie, the greater of the two is the
/// minimum that ends at the pass.
///
/// O(K (N log N + n) + n K log K) for K directions, N triangles and n places.  A function of solid, places,
/// directions and frame alone: neither threads nor memory change a bit.
/// @return per place, >= 0; 0 for places outside the solid and for normals (0, 0, 0).
/// @throws CoreError kBadInput when the number of directions is out of range, memory is 0 or the frame is
///   singular; kCancelled when the context asks to stop.
std::vector<double> barriers(const Solid& solid, std::span<const SheetPlace> places,
                             const BarrierOptions& options = {});

}  // namespace affskel::core
