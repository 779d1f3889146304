#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace affskel::core {

/// A partition of 0 .. size - 1 that only grows coarser (union-find; the smallest member stands for its set,
/// paths are halved on the way).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size = 0) { reset(size); }

  /// Every member by itself again; the memory is used again.
  void reset(std::size_t size) {
    parent_.resize(size);
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t find(std::uint32_t a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }

  /// Makes the sets of a and b one; false when they were already.
  bool unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (b < a) std::swap(a, b);
    parent_[b] = a;
    return true;
  }

  /// Per member the number of its set, in the order of their least members.
  std::vector<std::uint32_t> numbers(std::uint32_t& count) {
    std::vector<std::uint32_t> number(parent_.size());
    count = 0;
    for (std::uint32_t member = 0; member < number.size(); ++member) {
      const std::uint32_t least = find(member);
      number[member] = least == member ? count++ : number[least];
    }
    return number;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace affskel::core
