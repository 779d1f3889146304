#include "wire/direction_order.h"

#include <numeric>

namespace affskel::wire {

std::uint64_t direction_stride(std::uint64_t count) {
  if (count <= 2) return 1;
  // 2654435769 / 2^32 = 1 / golden ratio to 32 bits; integers, so that all machines agree.
  const std::uint64_t middle = (count * 2654435769ULL) >> 32;
  for (std::uint64_t offset = 0;; ++offset) {
    if (std::gcd(middle + offset, count) == 1) return middle + offset;
    if (offset < middle && std::gcd(middle - offset, count) == 1) return middle - offset;
  }
}

std::vector<std::uint32_t> directions_in_order(std::size_t count) {
  const std::uint64_t stride = direction_stride(count);
  std::vector<std::uint32_t> list(count);
  for (std::size_t p = 0; p < count; ++p)
    list[p] = static_cast<std::uint32_t>(direction_at(p, stride, count));
  return list;
}

}  // namespace affskel::wire
