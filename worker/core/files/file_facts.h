#pragma once

#include <optional>
#include <string>
#include <vector>

namespace affskel::core {

/// One thing that a file says of itself: job, mesh_sha256, v0, ...
struct FileFact {
  std::string key;  ///< letters, digits and underscores
  std::string text;
  std::optional<double> number = {};  ///< of a fact that is one; `text` then shows it
};

/// The fact `units` of all files.
inline constexpr const char* kFileUnits =
    "as submitted: lengths in those of the mesh, E and v0 in their cubes, areas in their squares";

/// In the order in which a file lists them, no key twice.
using FileFacts = std::vector<FileFact>;

}  // namespace affskel::core
