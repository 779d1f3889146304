#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "core/base/vec3.h"
#include "core/lattice/lattice.h"

namespace affskel::client {

/// The sample points of a job, in lattice order (x slowest, z fastest).
class LatticePoints {
 public:
  struct Run {
    std::uint64_t start;  ///< linear index of the first point
    std::uint32_t length;
  };

  /// @throws ClientError kInternal when the message contradicts itself.
  explicit LatticePoints(const v1::Lattice& lattice);

  std::uint64_t count() const { return count_; }
  const std::array<std::uint32_t, 3>& dims() const { return dims_; }
  const core::Vec3& origin() const { return origin_; }
  /// Where its places are, mesh units.
  core::LatticeGrid grid() const { return {origin_, axes_, dims_}; }
  const core::Vec3& axis(int k) const { return axes_[static_cast<std::size_t>(k)]; }
  const std::vector<Run>& runs() const { return runs_; }

  core::Vec3 position(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return origin_ + (double(i) * axes_[0] + (double(j) * axes_[1] + double(k) * axes_[2]));
  }

 private:
  std::array<std::uint32_t, 3> dims_{};
  core::Vec3 origin_;
  std::array<core::Vec3, 3> axes_;
  std::vector<Run> runs_;
  std::uint64_t count_ = 0;
};

/// One sample point: where it is in the lattice, and in space.
struct SamplePoint {
  std::uint32_t i = 0, j = 0, k = 0;
  core::Vec3 position;  ///< mesh units
};

/// Walks over the sample points in lattice order.
class LatticeCursor {
 public:
  /// `points` must outlive the cursor.
  explicit LatticeCursor(const LatticePoints& points) : points_(points) { enter_run(); }

  bool at_end() const { return run_ == points_.runs().size(); }
  SamplePoint point() const { return {i_, j_, k_, points_.position(i_, j_, k_)}; }
  void advance();

 private:
  void enter_run();

  const LatticePoints& points_;
  std::size_t run_ = 0;
  std::uint32_t left_ = 0;  // points of the run not yet passed
  std::uint32_t i_ = 0, j_ = 0, k_ = 0;
};

}  // namespace affskel::client
