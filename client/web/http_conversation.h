#pragma once

#include "client/web/http_transport.h"
// Asio after its repair in http_transport.h.
#include <array>
#include <boost/asio/thread_pool.hpp>

#include "client/web/http_limits.h"
#include "client/web/http_message.h"

namespace affskel::client {

/// The threads on which requests of one kind are answered.
struct AnswerThreads {
  explicit AnswerThreads(std::size_t threads) : pool(threads) {}
  boost::asio::thread_pool pool;
  std::size_t answers = 0;  ///< under way or waiting; only the thread that accepts touches it
};

/// What all conversations of a server share; must outlive them.
struct Conversations {
  std::array<AnswerThreads, 3>& threads;  ///< by AnswerKind
  const AdmitRequest& admit;
  const HttpLimits& limits;
};

/// Answers the requests of one connection, one after the other, until it ends or is too slow.
/// Throws boost::system::system_error when it breaks off.
boost::asio::awaitable<void> converse(HttpTransport& transport, const Conversations& shared);

}  // namespace affskel::client
