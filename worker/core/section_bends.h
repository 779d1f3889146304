#pragma once

#include <cstdint>
#include <vector>

#include "core/double_sum.h"
#include "core/height_order.h"
#include "core/tree_input.h"

namespace affskel::core {

/// Sudden changes of a component's A(t) and V(t) at one vertex, from level triangles and edges.
struct Jump {
  std::uint32_t rank = 0;
  double volume = 0;
  double area = 0;
  DoubleSum slope;
};

/// What one pass over the triangles leaves per vertex, by rank, for the sweep over the vertices.
struct SectionBends {
  std::vector<double> plain_bend;     ///< change of A'' / 2, the moderate part
  std::vector<DoubleSum> bend;        ///< and the rest: huge parts would swallow moderate ones added to them
  std::vector<std::uint32_t> down;    ///< rank of some lower neighbour, kNone at a minimum
  std::vector<std::uint8_t> middles;  ///< triangles it is the middle corner of: 2 per lower link component
  std::vector<std::uint32_t> lowest;  ///< per triangle: rank of its lowest corner
  std::vector<Jump> jumps;            ///< by rank

  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
};

/// Fills `out`, whose memory is reused, for unit vector d and the order of heights along it.  O(N), and
/// the sorting of the jumps.
void find_section_bends(const TreeInput::Data& input, const HeightOrder& heights, const Vec3& d,
                        SectionBends& out);

}  // namespace affskel::core
