#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/system/system_error.hpp>
#include <cstddef>

namespace affskel::net {

/// Some bytes of a stream, plain or over TLS; 0 when the peer has ended.  A peer over TLS that hangs up
/// without a word has ended, too: frames and requests say how long they are.
/// @throws boost::system::system_error
template <typename Stream>
boost::asio::awaitable<std::size_t> read_some(Stream& stream, boost::asio::mutable_buffer room) {
  namespace asio = boost::asio;
  boost::system::error_code error;
  const std::size_t got =
      co_await stream.async_read_some(room, asio::redirect_error(asio::use_awaitable, error));
  if (error && error != asio::error::eof && error != asio::ssl::error::stream_truncated)
    throw boost::system::system_error(error);
  co_return got;
}

}  // namespace affskel::net
