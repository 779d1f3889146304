#include "tools/heap_bytes.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace affskel::tests {
namespace {

std::atomic<std::uint64_t> taken{0}, most{0};

}  // namespace

std::uint64_t heap_bytes() {
  return taken;
}

std::uint64_t heap_peak() {
  return most;
}

void begin_heap_peak() {
  most = taken.load();
}

}  // namespace affskel::tests

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace affskel::tests {
namespace {

void count(std::uint64_t bytes) {
  const std::uint64_t now = taken += bytes;
  std::uint64_t known = most;
  while (now > known && !most.compare_exchange_weak(known, now)) {
  }
}

}  // namespace
}  // namespace affskel::tests

// The forms for arrays and those that do not throw call these.
void* operator new(std::size_t size) {
  void* const place = std::malloc(size);
  if (place == nullptr) throw std::bad_alloc();
  affskel::tests::count(malloc_usable_size(place));
  return place;
}

void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto least = static_cast<std::size_t>(alignment);
  void* const place = std::aligned_alloc(least, (size + least - 1) / least * least);
  if (place == nullptr) throw std::bad_alloc();
  affskel::tests::count(malloc_usable_size(place));
  return place;
}

void operator delete(void* place) noexcept {
  if (place != nullptr) affskel::tests::taken -= malloc_usable_size(place);
  std::free(place);
}

void operator delete(void* place, std::size_t) noexcept {
  operator delete(place);
}

void operator delete(void* place, std::align_val_t) noexcept {
  operator delete(place);
}

void operator delete(void* place, std::size_t, std::align_val_t) noexcept {
  operator delete(place);
}

#endif
