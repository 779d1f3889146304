#include "base/temporary_files.h"

#include <unistd.h>

#include <array>
#include <atomic>

#include "base/kept_text.h"

namespace affskel::base {
namespace {

std::array<std::atomic<const char*>, 8> temporary_paths{};

static_assert(std::atomic<const char*>::is_always_lock_free);

}  // namespace

void guard_temporary_file(const std::string& path) {
  const char* const kept = kept_text(path);
  for (std::atomic<const char*>& slot : temporary_paths) {
    const char* free = nullptr;
    if (slot.compare_exchange_strong(free, kept)) return;
  }
}

void release_temporary_file(const std::string& path) {
  for (std::atomic<const char*>& slot : temporary_paths) {
    const char* const guarded = slot.load();
    if (guarded != nullptr && path == guarded) slot.store(nullptr);
  }
}

void remove_guarded_files() noexcept {
  for (const std::atomic<const char*>& slot : temporary_paths) {
    if (const char* path = slot.load()) unlink(path);
  }
}

}  // namespace affskel::base
