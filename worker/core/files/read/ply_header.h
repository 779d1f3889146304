#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace affskel::core {

/// Types of PLY's numbers, in the order of the names in its description.
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

inline bool is_whole(PlyType type) {
  return type != PlyType::kFloat && type != PlyType::kDouble;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kDouble;
  bool list = false;
  PlyType count_type = PlyType::kUint8;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyEncoding { kText, kLittle, kBig };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  std::vector<PlyElement> elements;
  std::uint64_t curve_faces = 0;  ///< of the faces the last ones, see kPlyCurves
  std::uint64_t lines = 0;
  std::string_view body;  ///< what follows the header
};

/// Reads the header of a PLY file (Turk 1994) that begins with `bytes`.
/// @throws CoreError kBadInput with the line.
PlyHeader read_ply_header(std::string_view bytes);

}  // namespace affskel::core
