#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace affskel::core {

/// Calls body(i) once for every i in [0, count), on up to `threads` threads, the calling one among them.
/// Indices are begun in ascending order.  When calls throw, no further ones are begun, and the exception
/// of the least index is thrown once all threads are done: always the same one.
template <class Body>
void parallel_for(unsigned threads, std::size_t count, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;  // guarded by mutex, like the index it belongs to
  std::size_t error_index = count;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        body(i);
      } catch (...) {
        const std::lock_guard<std::mutex> guard(mutex);
        if (i < error_index) {
          error = std::current_exception();
          error_index = i;
        }
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < threads && i < count; ++i) helpers.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
}

/// Calls body(begin, end) for consecutive ranges that make up [0, count), on up to `threads` threads, as
/// parallel_for does.  The ranges depend on the number of threads, so nothing that is stored may depend on
/// where they end.
template <class Body>
void parallel_ranges(unsigned threads, std::size_t count, const Body& body) {
  // A few for each thread, since some may take longer than others; small work is not divided.
  constexpr std::size_t kRangesPerThread = 8, kMinPerRange = 1024;
  const std::size_t ranges =
      threads <= 1 ? 1 : std::min(kRangesPerThread * threads, count / kMinPerRange + 1);
  parallel_for(threads, ranges, [&](std::size_t r) { body(count * r / ranges, count * (r + 1) / ranges); });
}

/// Runs first(n) and second(n), at the same time when `threads` > 1; n is the number of threads that each may
/// use itself.  For recursions that halve their work.
template <class First, class Second>
void parallel_halves(unsigned threads, const First& first, const Second& second) {
  if (threads <= 1) {
    first(1U);
    second(1U);
    return;
  }
  parallel_for(threads, 2, [&](std::size_t half) {
    if (half == 0) {
      first((threads + 1) / 2);
    } else {
      second(threads / 2);
    }
  });
}

/// Number of nodes of a binary tree over `count` items.  Internal nodes give half of their items (rounded
/// down) to the first child and the rest to the second; leaves hold at most `leaf` items.  Called for a first
/// child, it tells where the second child's nodes begin in depth-first order, before any of them is made.
constexpr std::uint32_t halving_nodes(std::uint32_t count, std::uint32_t leaf) {
  // A level has nodes of two sizes only: `number` of `size` items, and `more` of one item more.
  std::uint32_t size = count, number = 1, more = 0, nodes = 0;
  while (size > leaf) {
    nodes += number + more;
    const std::uint32_t halves = 2 * (number + more);
    more = size % 2 == 1 ? number + 2 * more : more;
    number = halves - more;
    size /= 2;
  }
  // The larger ones may be halved once more.
  return nodes + number + (size == leaf ? 3 * more : more);
}

}  // namespace affskel::core
