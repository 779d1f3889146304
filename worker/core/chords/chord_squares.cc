#include "core/chords/chord_squares.h"

#include <algorithm>

namespace affskel::core {

std::vector<RimSquare> rim_squares(const SolidParts& parts, std::span<const ChordShock> shocks,
                                   std::span<const std::uint32_t> chosen) {
  std::vector<RimSquare> used;
  used.reserve(4 * chosen.size());
  for (const std::uint32_t s : chosen) {
    for (const LatticeElement& square : squares_round(edge_of(shocks[s], parts)))
      used.emplace_back(square, s);
  }
  std::sort(used.begin(), used.end());
  std::vector<RimSquare> rim;
  for (std::size_t first = 0, last; first < used.size(); first = last) {
    for (last = first + 1; last < used.size() && used[last].first == used[first].first;) ++last;
    if (last - first == 1) rim.push_back(used[first]);
  }
  return rim;
}

}  // namespace affskel::core
