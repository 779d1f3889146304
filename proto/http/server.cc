#include "http/server.h"

#include <signal.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <system_error>
#include <utility>

#include "base/end_limit.h"
#include "http/conversation.h"
#include "http/places.h"

namespace affskel::http {
namespace {

namespace asio = boost::asio;
using asio::use_awaitable;
using asio::ip::tcp;
using boost::system::error_code;

// Without descriptors, so much time for connections to end.
constexpr std::chrono::milliseconds kPause{100};
// Between looks for a place while newcomers wait: who came before them is mostly heard within less than a
// millisecond, and hundreds may wait.
constexpr std::chrono::microseconds kHearing{500};

// nohup and shells that start in the background have their process ignore some signals: it keeps that.
bool is_ignored(int signal_number) {
  struct sigaction current {};
  sigaction(signal_number, nullptr, &current);
  return current.sa_handler == SIG_IGN;
}

tcp::acceptor listen(asio::io_context& io, const wire::Address& address) {
  const auto fail = [](const error_code& error) {
    throw std::system_error(error ? std::error_code(error)
                                  : std::make_error_code(std::errc::address_not_available));
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

class Server::Impl {
 public:
  Impl(const wire::Address& address, TlsContexts tls, AdmitRequest admit, Limits limits)
      : tls_(std::move(tls)),
        admit_(std::move(admit)),
        limits_(limits),
        places_(limits.places),
        acceptor_(listen(io_, address)),
        threads_{AnswerThreads(limits.threads[0], limits.waiting, limits.waiting_of_one),
                 AnswerThreads(limits.threads[1], limits.waiting, limits.waiting_of_one),
                 AnswerThreads(limits.threads[2], limits.waiting, limits.waiting_of_one)} {}

  ~Impl() { io_.stop(); }

  int port() const { return acceptor_.local_endpoint().port(); }

  void run(bool by_signal) {
    asio::signal_set signals(io_);
    if (by_signal) {
      for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
        if (!is_ignored(signal_number)) signals.add(signal_number);
      }
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
      for (auto wait = places_.pause(); wait > Places::Clock::duration::zero(); wait = places_.pause()) {
        pause.expires_after(std::min<Places::Clock::duration>(wait, kHearing));
        co_await pause.async_wait(use_awaitable);
      }
      error_code error;
      tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(use_awaitable, error));
      if (error) {
        pause.expires_after(kPause);
        co_await pause.async_wait(use_awaitable);
        continue;
      }
      const asio::ip::address address = socket.remote_endpoint(error).address();
      if (!error) take(std::move(socket), peer_key(address));
    }
  }

  void take(tcp::socket socket, const std::string& peer) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    auto transport = make_transport(std::move(socket), tls_ ? tls_() : nullptr);
    auto place = places_.take(peer, [connection = transport.get()] { connection->close(); });
    if (place == nullptr) return;
    asio::co_spawn(io_, serve(std::move(transport), std::move(place), peer), asio::detached);
  }

  asio::awaitable<void> serve(std::unique_ptr<Transport> transport, std::unique_ptr<Places::Place> place,
                              std::string peer) {
    const Conversations shared{threads_, admit_, limits_};
    try {
      co_await converse(*transport, *place, peer, shared);
    } catch (const boost::system::system_error&) {
      // The peer went away, was too slow or had to give way: no peer is left to be told.
    }
  }

  TlsContexts tls_;
  AdmitRequest admit_;
  Limits limits_;
  Places places_;  // above io_: connections give their places back
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  std::array<AnswerThreads, 3> threads_;  // below io_: answers are told to it
};

Server::Server(const wire::Address& address, TlsContexts tls, AdmitRequest admit, Limits limits)
    : impl_(std::make_unique<Impl>(address, std::move(tls), std::move(admit), limits)) {}

Server::~Server() = default;

int Server::port() const {
  return impl_->port();
}

void Server::run(bool by_signal) {
  impl_->run(by_signal);
}

void Server::stop() {
  impl_->stop();
}

}  // namespace affskel::http
