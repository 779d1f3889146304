#pragma once

#include <cstdint>
#include <string>

namespace affskel::worker {

struct ComputeOptions {
  std::string file;                      ///< mesh to read, see core::parse_mesh_file
  double spacing = 0;                    ///< dT, mesh units; 0 = use points
  std::uint64_t points = 100000;         ///< sample points aimed at when spacing is 0
  std::string directions = "triangles";  ///< see core::make_directions
  std::string frame = "axis";            ///< of the lattice, see core::parse_frame
  std::string minimum = "set";           ///< over the directions, or "infimum" over all
  unsigned threads = 1;
  std::string repair_mode = "auto";  ///< "auto" or "none"
  bool prune = true;
  bool shuffle = false;  ///< work in a random order
  std::string output;    ///< field file, in one of core::field_formats() by its extension; empty = none
};

/// `affskel-worker compute`: prepare, erode and refine in this process, without a server.  Prints one line of
/// figures on stderr; writes the field when asked to.
/// @throws std::invalid_argument for an output that cannot hold the field; core::CoreError for bad input;
/// std::runtime_error when a file cannot be read or written.
void compute(const ComputeOptions& options);

}  // namespace affskel::worker
