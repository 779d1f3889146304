#pragma once

#include <cstdint>
#include <string>

namespace affskel::worker {

struct ComputeOptions {
  std::string file;                      ///< OFF file to read
  double spacing = 0;                    ///< dT, mesh units; 0 = use points
  std::uint64_t points = 100000;         ///< sample points aimed at when spacing is 0
  std::string directions = "triangles";  ///< see core::make_directions
  std::string frame = "axis";            ///< of the lattice, see core::parse_frame
  unsigned threads = 1;
  std::string repair_mode = "auto";  ///< "auto" or "none"
  bool prune = true;
  bool shuffle = false;  ///< work in a random order
  std::string output;    ///< field file (.csv or .dat), empty = none
};

/// `affskel-worker compute`: prepare and erode in this process, without a server.  Prints one line of
/// figures on stderr; writes the field when asked to.
/// @throws core::CoreError for bad input; std::runtime_error when a file cannot be read or written.
void compute(const ComputeOptions& options);

}  // namespace affskel::worker
