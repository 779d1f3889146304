#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Fields for the tests of the operator `chords`.

/// One smooth branch of E, in frame coordinates.
struct Branch {
  std::function<double(const Vec3&)> erosion;
  std::function<Vec3(const Vec3&)> gradient;
};

/// constant + slope.u
Branch linear_branch(double constant, const Vec3& slope);

/// A box of the given sides and its lattice of spacing 1: points (i, j, k), 0 <= i < a etc.
struct BoxLattice {
  Solid solid;
  Lattice lattice;
  BoxLattice(double a, double b, double c);
  /// @param box any mesh that bounds one.
  explicit BoxLattice(const Mesh& box);
};

/// The least of the branches at each sample point; a branch's number is its direction.
FrameField field_of_branches(const Lattice& lattice, const std::vector<Branch>& branches);

/// Of a lattice parallel to the coordinates.
std::array<Vec3, 3> cubic_axes(double h);

/// A solid eroded for real.
struct ErodedSolid {
  Solid solid;
  Lattice lattice;
  std::vector<std::array<std::uint32_t, 2>> saddles;  ///< of a refined field, per sample point
  FrameField field;

  /// @param axes of the lattice, mesh units; its points fill the solid's bounding box, centred.
  /// @param refined whether the field goes on from the directions to all.
  ErodedSolid(const Mesh& mesh, const std::array<Vec3, 3>& axes, const std::string& directions,
              bool refined = false);

  /// Mesh place of frame coordinates.
  Vec3 place(const Vec3& u) const;
};

}  // namespace affskel::core
