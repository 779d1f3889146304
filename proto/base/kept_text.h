#pragma once

#include <deque>
#include <string>

#include "base/mutex.h"

namespace affskel::base {

/// A copy that is never freed or changed, as signal handlers need what they read; null for an empty text.  A
/// few dozen bytes per call that stay to the end.  Thread-safe.
inline const char* kept_text(const std::string& text) {
  static Mutex mutex;
  static auto& kept = *new std::deque<std::string>;  // not destroyed at exit, where a signal may still come
  if (text.empty()) return nullptr;
  const MutexLock lock(mutex);
  return kept.emplace_back(text).c_str();
}

}  // namespace affskel::base
