#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace affskel::core {

/// Axis-parallel box, closed.
struct Box {
  std::array<double, 3> low, high;

  bool meets(const Box& other) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
    }
    return true;
  }
  void include(const Box& other);
};

/// Tightest box round a triangle.
Box box_of(const Mesh& mesh, const Triangle& triangle);

/// A balanced tree over boxes for overlap queries.  Immutable after construction; queries from several
/// threads are safe.
class BoxTree {
 public:
  /// O(N log N), on up to `threads` threads.
  explicit BoxTree(std::vector<Box> boxes, unsigned threads = 1);

  /// Replaces `out` by the indices of the boxes that meet `query` and are > `above`, ascending.
  void find(const Box& query, std::uint32_t above, std::vector<std::uint32_t>& out) const;

 private:
  /// A node covers items_[first, first + count); its left half is the next node, its right half `right`.
  struct Node {
    Box box;
    std::uint32_t first, count;
    std::uint32_t right;     // 0: a leaf
    std::uint32_t greatest;  // of the indices below
  };

  void build(std::uint32_t index, std::uint32_t first, std::uint32_t count, unsigned threads);

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> items_;
  std::vector<Node> nodes_;
};

}  // namespace affskel::core
