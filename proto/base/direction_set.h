#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace affskel::base {

/// Most directions of one job; sphere:N counts as N.
inline constexpr std::uint64_t kMaxDirections = std::uint64_t{1} << 24;

/// One part of a direction set as people write it: "triangles", "sphere:N" or "random:N:SEED".
struct DirectionSetPart {
  enum class Kind { kTriangles, kSphere, kRandom };
  Kind kind = Kind::kTriangles;
  std::uint64_t count = 0;  ///< N >= 1 of sphere and random
  std::uint64_t seed = 0;   ///< of random

  /// Spelled without blanks and leading zeros.
  std::string text() const;
};

/// The parts of a direction set, which are joined by "+".
/// @throws std::invalid_argument that names the part and what is wrong with it.  No limit on N is applied.
std::vector<DirectionSetPart> parse_direction_set(std::string_view text);

/// What is wrong with a part, in the words of parse_direction_set.
std::string direction_set_error(std::string_view part, std::string_view why);

}  // namespace affskel::base
