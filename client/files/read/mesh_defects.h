#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/text/off_file.h"

namespace affskel::client {

/// A kind of defect that keeps a mesh from bounding a solid.
struct MeshDefect {
  std::string code;  ///< "open-edges", "crowded-edges", "repeated-triangles", "degenerate-triangles"
  std::uint64_t count = 0;
  std::string message;               ///< count, cause and the first places
  std::vector<std::uint64_t> lines;  ///< lines of the first places, at most five
};

/// Every kind of topological defect, with its first places.  Coincident vertices count as one, as in the
/// repair.
std::vector<MeshDefect> find_defects(const core::OffMesh& off);

}  // namespace affskel::client
