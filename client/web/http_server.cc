#include "client/web/http_server.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <csignal>
#include <map>

#include "base/end_limit.h"
#include "client/base/error.h"
#include "client/web/http_conversation.h"

namespace affskel::client {
namespace {

namespace asio = boost::asio;
using asio::use_awaitable;
using asio::ip::tcp;
using boost::system::error_code;

// Without descriptors, so much time for connections to end.
constexpr std::chrono::milliseconds kPause{100};

tcp::acceptor listen(asio::io_context& io, const wire::Address& address) {
  const auto fail = [&](const error_code& error) {
    throw ClientError(ExitCode::kUsage, "cannot listen on " + address.target() + ": " + error.message());
  };
  error_code error;
  const auto found =
      tcp::resolver(io).resolve(address.host, std::to_string(address.port), tcp::resolver::passive, error);
  if (error || found.empty()) fail(error);
  tcp::acceptor acceptor(io);
  const tcp::endpoint endpoint = *found.begin();
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error) fail(error);
  return acceptor;
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(const wire::Address& address, TlsIdentity* identity, AdmitRequest admit, HttpLimits limits)
      : identity_(identity),
        admit_(std::move(admit)),
        limits_(limits),
        acceptor_(listen(io_, address)),
        threads_{AnswerThreads(limits.threads[0]), AnswerThreads(limits.threads[1]),
                 AnswerThreads(limits.threads[2])} {}

  ~Impl() {
    io_.stop();
    for (AnswerThreads& threads : threads_) threads.pool.stop();
    for (AnswerThreads& threads : threads_) threads.pool.join();
  }

  int port() const { return acceptor_.local_endpoint().port(); }

  void run(bool by_signal) {
    asio::signal_set signals(io_);
    if (by_signal) {
      for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) signals.add(signal_number);
      signals.async_wait([this](const error_code& error, int) {
        if (error) return;
        base::limit_end();
        io_.stop();
      });
    }
    asio::co_spawn(io_, accept(), asio::detached);
    io_.run();
  }

  void stop() { io_.stop(); }

 private:
  asio::awaitable<void> accept() {
    asio::steady_timer pause(io_);
    for (;;) {
      error_code error;
      tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(use_awaitable, error));
      if (error) {
        pause.expires_after(kPause);
        co_await pause.async_wait(use_awaitable);
        continue;
      }
      const asio::ip::address peer = socket.remote_endpoint(error).address();
      if (!error && has_room(peer)) asio::co_spawn(io_, serve(std::move(socket), peer), asio::detached);
    }
  }

  bool has_room(const asio::ip::address& peer) const {
    if (open_ >= limits_.connections) return false;
    const auto of_peer = open_of_.find(peer);
    return peer.is_loopback() || of_peer == open_of_.end() || 2 * of_peer->second < limits_.connections;
  }

  asio::awaitable<void> serve(tcp::socket socket, asio::ip::address peer) {
    ++open_;
    ++open_of_[peer];
    try {
      co_await talk(std::move(socket));
    } catch (const boost::system::system_error&) {
      // The peer went away or was too slow: nobody is there to be told.
    }
    --open_;
    if (--open_of_[peer] == 0) open_of_.erase(peer);
  }

  asio::awaitable<void> talk(tcp::socket socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    const Conversations shared{threads_, admit_, limits_};
    const auto transport =
        make_transport(std::move(socket), identity_ == nullptr ? nullptr : identity_->context());
    co_await converse(*transport, shared);
  }

  TlsIdentity* identity_;
  AdmitRequest admit_;
  HttpLimits limits_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  std::array<AnswerThreads, 3> threads_;  // below io_: what still waits for a thread holds sockets
  std::size_t open_ = 0;
  std::map<asio::ip::address, std::size_t> open_of_;
};

HttpServer::HttpServer(const wire::Address& address, TlsIdentity* identity, AdmitRequest admit,
                       HttpLimits limits)
    : impl_(std::make_unique<Impl>(address, identity, std::move(admit), limits)) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const {
  return impl_->port();
}

void HttpServer::run(bool by_signal) {
  impl_->run(by_signal);
}

void HttpServer::stop() {
  impl_->stop();
}

}  // namespace affskel::client
