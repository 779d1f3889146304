#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace affskel::core {

/// Lists of values, one after the other in one array (compressed sparse rows): neighbours of vertices,
/// triangles of vertices, sides of edges.
template <class Value>
class Groups {
 public:
  Groups() = default;

  /// By counting, in linear time; within a group values keep their order.
  /// @param count how many groups there are.
  /// @param list list(put) calls put(group, value) for every value; called twice, to the same effect.
  template <class List>
  Groups(std::size_t count, const List& list) : begin_(count + 2, 0) {
    list([&](std::size_t group, const Value&) { ++begin_[group + 2]; });
    for (std::size_t g = 2; g < begin_.size(); ++g) begin_[g] += begin_[g - 1];
    values_.resize(begin_.back());
    list([&](std::size_t group, const Value& value) { values_[begin_[group + 1]++] = value; });
    begin_.pop_back();
  }

  std::size_t size() const { return begin_.size() - 1; }

  std::span<const Value> operator[](std::size_t group) const {
    return {values_.data() + begin_[group], values_.data() + begin_[group + 1]};
  }
  std::span<Value> operator[](std::size_t group) {
    return {values_.data() + begin_[group], values_.data() + begin_[group + 1]};
  }

 private:
  std::vector<std::size_t> begin_ = {0};  // per group, and one past the end
  std::vector<Value> values_;
};

/// Of each of `count` members the numbers of the lists that hold it, ascending: of vertices their triangles, say.
template <class Lists>
Groups<std::uint32_t> holders(std::size_t count, const Lists& lists) {
  return {count, [&](const auto& put) {
            for (std::uint32_t n = 0; n < lists.size(); ++n)
              for (const std::uint32_t member : lists[n]) put(member, n);
          }};
}

}  // namespace affskel::core
