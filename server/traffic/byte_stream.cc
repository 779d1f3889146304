#include "traffic/byte_stream.h"

#include <openssl/ssl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

#include "net/peer_has_ended.h"
#include "net/read_some.h"

namespace affskel::server {
namespace {

namespace asio = boost::asio;
using asio::use_awaitable;
using boost::system::error_code;
using Socket = asio::generic::stream_protocol::socket;

int family_of(int fd) {
  int family = AF_UNIX;
  socklen_t size = sizeof family;
  getsockopt(fd, SOL_SOCKET, SO_DOMAIN, &family, &size);
  return family;
}

/// What both have in common.
template <typename Stream>
class StreamOf : public ByteStream {
 public:
  template <typename... Arguments>
  explicit StreamOf(Arguments&&... arguments) : stream_(std::forward<Arguments>(arguments)...) {}

  asio::awaitable<std::size_t> read(asio::mutable_buffer room) override {
    return net::read_some(stream_, room);
  }

  asio::awaitable<void> write(asio::const_buffer bytes) override {
    co_await asio::async_write(stream_, bytes, use_awaitable);
  }

  bool peer_has_ended() override { return net::peer_has_ended(stream_.lowest_layer().native_handle()); }

  void end() override {
    error_code ignored;
    stream_.lowest_layer().shutdown(Socket::shutdown_send, ignored);
  }

  void close() override {
    error_code ignored;
    stream_.lowest_layer().close(ignored);
  }

 protected:
  Stream stream_;
};

class PlainStream : public StreamOf<Socket> {
 public:
  using StreamOf::StreamOf;
  asio::awaitable<void> begin() override { co_return; }
  bool has_certificate() const override { return false; }
  asio::awaitable<void> wait() override { co_await stream_.async_wait(Socket::wait_read, use_awaitable); }
};

class TlsStream : public StreamOf<asio::ssl::stream<Socket>> {
 public:
  TlsStream(Socket socket, std::shared_ptr<asio::ssl::context> tls)
      : StreamOf(std::move(socket), *tls), tls_(std::move(tls)) {}
  asio::awaitable<void> begin() override {
    co_await stream_.async_handshake(asio::ssl::stream_base::server, use_awaitable);
  }
  /// A certificate that is not good ends the handshake.
  bool has_certificate() const override {
    X509* const shown = SSL_get_peer_certificate(const_cast<TlsStream*>(this)->stream_.native_handle());
    X509_free(shown);
    return shown != nullptr;
  }
  asio::awaitable<void> wait() override { co_return; }

 private:
  const std::shared_ptr<asio::ssl::context> tls_;
};

}  // namespace

std::unique_ptr<ByteStream> make_stream(const asio::any_io_executor& executor, int fd,
                                        std::shared_ptr<asio::ssl::context> tls) {
  Socket socket(executor);
  error_code error;
  socket.assign(asio::generic::stream_protocol(family_of(fd), 0), fd, error);
  if (error) {
    ::close(fd);
    throw boost::system::system_error(error);
  }
  if (tls == nullptr) return std::make_unique<PlainStream>(std::move(socket));
  return std::make_unique<TlsStream>(std::move(socket), std::move(tls));
}

}  // namespace affskel::server
