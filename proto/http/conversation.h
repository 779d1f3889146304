#pragma once

#include <array>
#include <string>

#include "http/answer_threads.h"
#include "http/limits.h"
#include "http/message.h"
#include "http/places.h"
#include "http/transport.h"

namespace affskel::http {

/// What all conversations of a server share; must outlive them.
struct Conversations {
  std::array<AnswerThreads, 3>& threads;  ///< by AnswerKind
  const AdmitRequest& admit;
  const Limits& limits;
};

/// Answers the requests of one connection, one after the other, until it ends, is too slow, or its place is
/// given to another.  Throws boost::system::system_error when it breaks off.
/// @param place its own. @param peer see peer_key.
boost::asio::awaitable<void> converse(Transport& transport, Places::Place& place, const std::string& peer,
                                      const Conversations& shared);

}  // namespace affskel::http
