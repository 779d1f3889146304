#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace affskel::core {

/// The middle one of some values, not none; of an even number the greater of the two.
template <class Value>
Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace affskel::core
