#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "base/pace.h"

namespace affskel::http {

/// How many connections there are, and which give way to newcomers; see Places.
struct PlaceLimits {
  std::size_t connections = 256;  ///< at a time
  /// Of the connections, so many are kept for owners that are known.
  std::size_t for_known = 64;
  std::size_t of_owner = 32;  ///< of one owner that is known
  /// For so long a connection that does nothing counts as one that is about to.
  std::chrono::milliseconds grace{500};
  /// So long a stranger that says nothing yet keeps a place, to be greeted and heard across a slow network, unless
  /// its own address has half of them.  Who comes meanwhile waits: the fewer connections, the longer.
  std::chrono::milliseconds stay{250};
};

/// The threads for answers of one kind; see AnswerThreads.
struct ThreadLimits {
  std::size_t threads = 1;
  std::size_t of_one = 1;  ///< of them, for one asker
};

/// Bounds of an HTTP service; what exceeds them is closed or refused, so that no peer holds it for others.
struct Limits {
  PlaceLimits places;
  /// For answers that are quick, that compute here, and that wait for others; see AnswerKind.
  std::array<ThreadLimits, 3> threads = {{{8, 4}, {3, 1}, {24, 4}}};
  std::size_t waiting = 128;        ///< answers of one kind under way or waiting; more get status 503
  std::size_t waiting_of_one = 32;  ///< of them, for one asker
  /// Of a request's head; of all that is in a body beside its content: sizes, extensions and trailers of
  /// chunks.
  std::uint32_t header_bytes = 16 * 1024;
  std::chrono::milliseconds header{
      10000};                             ///< from a connection's or request's first byte to the last header
  std::chrono::milliseconds idle{15000};  ///< a connection without requests is closed after this
  base::PaceOptions pace;                 ///< of bodies and answers
};

}  // namespace affskel::http
