#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::experiments {

struct NamedMesh {
  std::string name;
  core::Mesh mesh;
};

/// Solids with limbs, handles and cavities, each about 2 across: a hand, an animal, a tree, a comb, a trefoil
/// knot, an amphora, a block with three holes, a hollow ball, a torus.
/// @param triangles of each, even.
std::vector<NamedMesh> limbed_solids(std::size_t triangles);

}  // namespace affskel::experiments
