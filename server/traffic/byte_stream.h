#pragma once

// First: Asio 1.74 uses std::exchange without its header.
#include <utility>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/ssl/context.hpp>
#include <memory>

namespace affskel::server {

/// The bytes of one connection, as they are or over TLS.  Its functions throw boost::system::system_error.
/// For one thread at a time.
class ByteStream {
 public:
  virtual ~ByteStream() = default;

  /// Before the first byte.
  virtual boost::asio::awaitable<void> begin() = 0;
  /// Whether the peer has shown a certificate, which then is good.
  virtual bool has_certificate() const = 0;
  /// Until read() would not wait, where that can be known: so that a silent connection needs no buffer.
  virtual boost::asio::awaitable<void> wait() = 0;
  /// Some bytes; 0 when the peer has ended.
  virtual boost::asio::awaitable<std::size_t> read(boost::asio::mutable_buffer room) = 0;
  /// All of them.
  virtual boost::asio::awaitable<void> write(boost::asio::const_buffer bytes) = 0;
  /// Whether the peer has ended, even if bytes that it sent before wait to be read.
  virtual bool peer_has_ended() = 0;
  /// Tells the peer that nothing more comes.
  virtual void end() = 0;
  /// Ends what is under way.
  virtual void close() = 0;
};

/// @param fd a connected socket, not blocking; the stream's from now on, and closed when it throws.
/// @param tls null = none.
std::unique_ptr<ByteStream> make_stream(const boost::asio::any_io_executor& executor, int fd,
                                        std::shared_ptr<boost::asio::ssl::context> tls);

}  // namespace affskel::server
