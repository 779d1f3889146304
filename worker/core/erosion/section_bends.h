#pragma once

#include <cstdint>
#include <vector>

#include "core/base/double_sum.h"
#include "core/base/none.h"
#include "core/erosion/height_order.h"
#include "core/erosion/tree_input.h"

namespace affskel::core {

/// Sudden changes of a component's A(t) and V(t) at one vertex, from level triangles and edges.
struct Jump {
  std::uint32_t rank = 0;
  double volume = 0;
  double area = 0;
  DoubleSum slope;
};

/// What one pass over the triangles leaves for the sweep over the vertices.
struct SectionBends {
  using Pair = double __attribute__((vector_size(16)));  ///< a register's worth

  /// Kept together: triangles meet their vertices in any order, and each visit is then one access to memory.
  struct alignas(32) Vertex {
    Pair bend = {0, 0};  ///< change of A'' / 2: the sum of multiples of a unit near v0, and of the rest
    double height = 0;
    std::uint32_t rank = 0;      ///< by height
    std::uint32_t down = kNone;  ///< some lower neighbour, kNone at a minimum
  };
  /// Data that few visits need: only those of middle corners and of nearly level triangles.
  struct Link {
    std::uint32_t middles = 0;    ///< triangles it is the middle corner of: 2 per lower link component
    std::uint32_t steep = kNone;  ///< index into steep_bend, kNone when it has none
  };

  std::vector<Vertex> vertices;       ///< per vertex
  std::vector<Link> links;            ///< per vertex
  std::vector<DoubleSum> steep_bend;  ///< what nearly level triangles add to the bends of their corners
  std::vector<std::uint32_t> lowest;  ///< per triangle: its lowest corner
  std::vector<Jump> jumps;            ///< by rank

  /// Prefetches the data of a vertex.
  void prefetch(std::uint32_t vertex) const {
    __builtin_prefetch(&vertices[vertex]);
    __builtin_prefetch(&links[vertex]);
  }
};

/// Fills `out`, whose memory is reused, for unit vector d and the order of heights along it.  O(N), and
/// the sorting of the jumps.
void find_section_bends(const TreeInput& input, const HeightOrder& heights, const Vec3& d, SectionBends& out);

}  // namespace affskel::core
