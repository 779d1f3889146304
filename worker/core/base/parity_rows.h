#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

namespace affskel::core {

/// A set, ascending: a vector over the field of two elements.
using ParityRow = std::vector<std::uint32_t>;

/// The sum modulo 2 of two sets, ascending: what is in one of them alone.
template <class Member>
std::vector<Member> parity_sum(const std::vector<Member>& a,
                               const std::type_identity_t<std::vector<Member>>& b) {
  std::vector<Member> result;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

/// The span of rows over the field of two elements, by elimination.
class ParityRows {
 public:
  /// @return whether it was not in the span before.
  bool add(ParityRow row) {
    row = reduced(std::move(row));
    if (row.empty()) return false;
    const std::uint32_t first = row.front();
    rows_.emplace(first, std::move(row));
    return true;
  }

  bool contains(ParityRow row) const { return reduced(std::move(row)).empty(); }

  std::uint64_t rank() const { return rows_.size(); }

 private:
  ParityRow reduced(ParityRow row) const {
    while (!row.empty()) {
      const auto known = rows_.find(row.front());
      if (known == rows_.end()) break;
      row = parity_sum(row, known->second);
    }
    return row;
  }

  std::map<std::uint32_t, ParityRow> rows_;  // by first member
};

}  // namespace affskel::core
