#pragma once

// First: Asio 1.74 uses std::exchange without its header.
#include <utility>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <memory>

namespace affskel::http {

/// The bytes of one connection, as they are or over TLS.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Time for what follows, until the next call; then it ends with a system_error.
  virtual void allow(std::chrono::milliseconds time) = 0;
  /// The same without an end.
  virtual void allow_any_time() = 0;

  /// Before the first byte.
  virtual boost::asio::awaitable<void> begin() = 0;
  /// Some bytes; 0 when the peer has ended.  All throw boost::system::system_error.
  virtual boost::asio::awaitable<std::size_t> read(boost::asio::mutable_buffer room) = 0;
  virtual boost::asio::awaitable<std::size_t> write(boost::asio::const_buffer bytes) = 0;
  /// Tells the peer that nothing more comes.
  virtual boost::asio::awaitable<void> end() = 0;

  /// Ends what is under way, and all that follows, with a system_error.
  virtual void close() = 0;
  /// Whether the peer has closed its end, read or not.
  virtual bool has_peer_gone() = 0;

  virtual bool is_secure() const = 0;
};

/// @param context null = no TLS.
std::unique_ptr<Transport> make_transport(boost::asio::ip::tcp::socket socket,
                                          std::shared_ptr<boost::asio::ssl::context> context);

}  // namespace affskel::http
