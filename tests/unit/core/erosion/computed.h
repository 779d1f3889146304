#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/erosion/erosion.h"

namespace affskel::core {

/// E at sample points, in mesh units.
struct Computed {
  Solid solid;
  Lattice lattice;
  DirectionSet directions;
  std::vector<Vec3> place;
  std::vector<FieldValue> value;
  SweepCounts counts;
};

struct How {
  unsigned threads = 1;
  bool prune = true;
  std::uint64_t shuffle = 0;  // seed; 0 = in order
};

Lattice lattice_of(const Solid& solid, double spacing);

/// Erodes the solid at the lattice's points by a direction set.
Computed compute(Solid solid, Lattice lattice, const std::string& directions, const How& how = {});
Computed compute(const Mesh& mesh, double spacing, const std::string& directions, const How& how = {});

/// With points in the middle planes of the solid's box, where two chords can be equal.
Computed compute_through_the_middle(const Mesh& mesh, double spacing, const std::string& directions);

bool same_bytes(const Computed& a, const Computed& b);

}  // namespace affskel::core
