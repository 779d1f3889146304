#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/matrix3.h"
#include "core/base/vec3.h"
#include "core/solid/solid.h"
#include "core/solid/solid_frame.h"

namespace affskel::core {

/// Lattice point (i, j, k) lies at origin + i axes[0] + j axes[1] + k axes[2], 0 <= i < dims[0] etc.
struct LatticeGrid {
  Vec3 origin;
  std::array<Vec3, 3> axes;
  std::array<std::uint32_t, 3> dims{};
};

/// Consecutive sample points of a lattice line with no surface crossing between them.
struct LatticeRun {
  /// Place of its first point in AxisRuns::order (the point itself if that is empty).
  std::uint32_t first = 0;
  std::uint32_t length = 0;              ///< number of points, >= 1
  std::uint32_t low = 0;                 ///< the nearest triangle below where the line enters the solid
  std::uint32_t high = 0;                ///< the nearest triangle above where it leaves
  std::array<std::uint32_t, 3> start{};  ///< lattice indices of the first point
};

/// All sample points, in runs along one axis.
struct AxisRuns {
  std::vector<LatticeRun> runs;
  std::vector<std::uint32_t> order;  ///< sample points run by run; empty for axis 2, where it is 0, 1, 2, ...
  /// Sample points within rounding of the surface that lie outside on their line along this axis.  Each is a
  /// run of one point along axis 2: low and high are those of axis 2, `first` is the point itself.
  std::vector<LatticeRun> strays;
};

/// The sample points of a solid: lattice points inside it, numbered in lattice order (axis 2 fastest).
struct Lattice {
  LatticeGrid grid;  ///< scaled coordinates of the solid
  /// dT, mesh units: the cube root of the volume of the frame's cell.
  double spacing = 0;
  std::uint32_t points = 0;
  std::array<AxisRuns, 3> axis;
};

/// Places of the sample points in mesh units: o + (i a + (j b + k c)), the vectors rounded once.
class SamplePlaces {
 public:
  SamplePlaces(const Solid& solid, const Lattice& lattice)
      : origin_(solid.centre + solid.scale() * lattice.grid.origin),
        axes_{solid.scale() * lattice.grid.axes[0], solid.scale() * lattice.grid.axes[1],
              solid.scale() * lattice.grid.axes[2]} {}

  const Vec3& origin() const { return origin_; }
  const std::array<Vec3, 3>& axes() const { return axes_; }

  Vec3 at(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return origin_ + (i * axes_[0] + (j * axes_[1] + k * axes_[2]));
  }

 private:
  Vec3 origin_;
  std::array<Vec3, 3> axes_;
};

struct LatticeOptions {
  double spacing = 0;                                 ///< dT, mesh units; > 0, or 0 to use target_points
  std::uint64_t target_points = 0;                    ///< sets dT, see spacing_for_points
  Matrix3 frame = kIdentity3;                         ///< F of det 1, see solid_frame
  std::uint64_t max_points = std::uint64_t{1} << 31;  ///< refuse lattices that would give more
  /// The same for its lines, along all axes: each takes 16 bytes before any point is found.
  std::uint64_t max_lines = 400'000'000;
  unsigned threads = 1;                 ///< >= 1; the lattice does not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop
  /// Bytes that the lattice, and what the caller is going to keep beside it, may take; 0 = no bound.
  std::uint64_t memory_budget = 0;
  double point_bytes = 0;  ///< that the caller is going to take for every sample point
};

/// The lattice parallel to the axes of the frame, of step dT in the frame's units, centred on the solid's
/// bounding box in the frame's coordinates u = F^-1 (x - centre), and the sample points in it (see
/// scan_convert).  A point is inside when, along axis 2, the surfaces below it enter more often than they
/// leave.
///
/// Places lie dT / 2, 3 dT / 2, ... to either side of the box's middle planes, as far as they are inside the
/// box by more than 5e-10 of its side; where a side is at most dT, in its middle plane.  So no place lies in
/// the middle planes of other solids, where symmetric ones have their skeleton.
/// @throws CoreError kBadInput when spacing is not > 0 and finite, or no point falls inside; kLimit, naming
///   the least spacing within the limits, when there would be more than max_points or max_lines, or lattice
///   and caller would take more than the memory budget; kCancelled when the context asks to stop.
Lattice make_lattice(const Solid& solid, const LatticeOptions& options);

/// Throws what make_lattice would throw for its limits, before a lattice is made.  Does not find out whether
/// a point falls inside, nor whether the search for target_points ends within the limits.  The frame is
/// computed only when the answer depends on it.
/// @param options `frame` is not used.
void check_lattice(const Solid& solid, FrameKind kind, LatticeOptions options);

/// How many sample points make_lattice would give for options.spacing, by one scan conversion; nothing when
/// there would be more points or lines than the limits.
std::optional<std::uint32_t> lattice_points(const Solid& solid, const LatticeOptions& options);

/// The same for a given grid in scaled coordinates; axes need not be orthogonal or of equal length.
Lattice make_lattice(const Solid& solid, const LatticeGrid& grid, unsigned threads = 1);

}  // namespace affskel::core
