#include "http/transport.h"

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include "net/peer_has_ended.h"
#include "net/read_some.h"

namespace affskel::http {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::use_awaitable;
using boost::system::error_code;

// What both have in common.
template <typename Stream>
class StreamTransport : public Transport {
 public:
  template <typename... Arguments>
  explicit StreamTransport(Arguments&&... arguments) : stream_(std::forward<Arguments>(arguments)...) {}

  void allow(std::chrono::milliseconds time) override {
    beast::get_lowest_layer(stream_).expires_after(time);
  }
  void allow_any_time() override { beast::get_lowest_layer(stream_).expires_never(); }
  void close() override { beast::get_lowest_layer(stream_).close(); }
  bool has_peer_gone() override {
    return net::peer_has_ended(beast::get_lowest_layer(stream_).socket().native_handle());
  }

  asio::awaitable<std::size_t> read(asio::mutable_buffer room) override {
    return net::read_some(stream_, room);
  }

  asio::awaitable<std::size_t> write(asio::const_buffer bytes) override {
    const std::size_t put = co_await stream_.async_write_some(bytes, use_awaitable);
    co_return put;
  }

 protected:
  Stream stream_;
};

class PlainTransport : public StreamTransport<beast::tcp_stream> {
 public:
  using StreamTransport::StreamTransport;
  asio::awaitable<void> begin() override { co_return; }
  asio::awaitable<void> end() override {
    error_code ignored;
    stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    co_return;
  }
  bool is_secure() const override { return false; }
};

class TlsTransport : public StreamTransport<beast::ssl_stream<beast::tcp_stream>> {
 public:
  TlsTransport(asio::ip::tcp::socket socket, std::shared_ptr<asio::ssl::context> context)
      : StreamTransport(std::move(socket), *context), context_(std::move(context)) {}
  asio::awaitable<void> begin() override {
    co_await stream_.async_handshake(asio::ssl::stream_base::server, use_awaitable);
  }
  asio::awaitable<void> end() override {
    error_code ignored;
    co_await stream_.async_shutdown(asio::redirect_error(use_awaitable, ignored));
  }
  bool is_secure() const override { return true; }

 private:
  std::shared_ptr<asio::ssl::context> context_;
};

}  // namespace

std::unique_ptr<Transport> make_transport(asio::ip::tcp::socket socket,
                                          std::shared_ptr<asio::ssl::context> context) {
  if (context == nullptr) return std::make_unique<PlainTransport>(std::move(socket));
  return std::make_unique<TlsTransport>(std::move(socket), std::move(context));
}

}  // namespace affskel::http
