#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/read/vtk_data.h"

namespace affskel::core {

/// What a piece of a VTK XML PolyData file holds.
struct VtpPiece {
  /// The arrays of each of its sections: "Points", "PointData", "Polys", ...
  std::map<std::string, std::vector<VtkArray>> arrays;
  /// "Points", "Polys", ...: as many as its tag says, if it does.
  std::map<std::string, std::uint64_t> announced;
  std::uint64_t line = 0;
};

/// What the XML of such a file says.
struct VtpDescription {
  VtkEncoding encoding;
  std::vector<VtpPiece> pieces;
  std::deque<std::string> texts;  ///< of arrays, where they do not stand in the file in one piece
};

/// Reads the XML, up to the appended data.  `bytes` must outlive what is returned.
/// @throws CoreError kBadInput with the line.
VtpDescription read_vtp_description(std::string_view bytes);

}  // namespace affskel::core
