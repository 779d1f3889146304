#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/packed_numbers.h"

namespace affskel::core {

/// A type of PLY's numbers.
struct PlyType {
  std::array<std::string_view, 2> names;  ///< either
  base::NumberKind kind;
  bool whole;
  double least, most;
};

struct PlyProperty {
  std::string name;
  const PlyType* type = nullptr;
  bool list = false;
  const PlyType* count_type = nullptr;  ///< of a list
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
