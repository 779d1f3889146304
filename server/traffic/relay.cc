#include "traffic/relay.h"

// First: Asio 1.74 uses std::exchange without its header.
#include <utility>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/system/system_error.hpp>
#include <cerrno>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <vector>

#include "base/mutex.h"
#include "traffic/byte_stream.h"

namespace affskel::server {
namespace {

namespace asio = boost::asio;
using asio::use_awaitable;
using Clock = std::chrono::steady_clock;

// Passed on at once: a frame of the size that HTTP/2 begins with, and a record of TLS.
constexpr std::size_t kPieceBytes = 16384;

// From clients that send more than that at a time, as workers do with their reports: every piece costs a dozen
// calls of the system.  So many clients may at once.
constexpr std::size_t kLargePieceBytes = std::size_t{256} << 10;
constexpr std::size_t kLargeSenders = 64;

// Of a connection over TCP: bytes that wait in the system to be sent.
constexpr int kMostUnsentBytes = 128 << 10;

// Between two ticks: the process was stopped.
constexpr std::chrono::seconds kStandstill{2};

// Peers of which is known what they owe, before those that owe nothing are forgotten.
constexpr std::size_t kMaxPeers = 4096;

constexpr Clock::time_point kNever = Clock::time_point::max();

/// Room for a piece while one is on its way.
class Piece {
 public:
  explicit Piece(std::size_t size) : size_(size), bytes_(std::make_unique_for_overwrite<char[]>(size)) {}
  asio::mutable_buffer room() { return asio::buffer(bytes_.get(), size_); }
  std::string_view first(std::size_t size) const { return {bytes_.get(), size}; }

 private:
  std::size_t size_;
  std::unique_ptr<char[]> bytes_;
};

}  // namespace

/// What the connections of a relay share.
struct Relay::Shared {
  explicit Shared(const RelayOptions& given) : options(given), of_all(given.of_all, Clock::now()) {}

  /// Writes down so many frames that make work, or calls that ended with their connection.
  /// @return how long to wait after them.
  Clock::duration charge(const std::string& peer, std::size_t frames) {
    const Clock::time_point now = Clock::now();
    const auto tokens = static_cast<double>(frames);
    const base::MutexLock lock(mutex);
    if (of_peers.size() >= kMaxPeers) {
      std::erase_if(of_peers, [now](const auto& one) { return one.second.taken(now) <= 0; });
    }
    TokenBucket& of_peer = of_peers.try_emplace(peer, options.of_peer, now).first->second;
    return std::max(of_peer.take(tokens, now), of_all.take(tokens, now));
  }

  /// How long to wait for what a peer owes.
  Clock::duration debt(const std::string& peer) {
    const base::MutexLock lock(mutex);
    const auto found = of_peers.find(peer);
    return found == of_peers.end() ? Clock::duration::zero() : found->second.take(0, Clock::now());
  }

  const RelayOptions options;
  std::atomic<std::size_t> held_frames = 0;
  std::atomic<std::size_t> large_senders = 0;
  base::Mutex mutex;
  std::unordered_map<std::string, TokenBucket> of_peers ABSL_GUARDED_BY(mutex);
  TokenBucket of_all ABSL_GUARDED_BY(mutex);
  std::unordered_map<Connection*, std::weak_ptr<Connection>> connections ABSL_GUARDED_BY(mutex);
  Clock::time_point ticked ABSL_GUARDED_BY(mutex) = Clock::now();
  Clock::time_point awake ABSL_GUARDED_BY(mutex) = {};  // since when the process has run without a stop
  asio::io_context context;
  asio::executor_work_guard<asio::io_context::executor_type> work{context.get_executor()};
  std::vector<std::thread> threads;
};

/// One client's.  It lives as long as one of its two coroutines does, which run in one strand.
class Relay::Connection final : public RelayLine, public std::enable_shared_from_this<Connection> {
 public:
  Connection(Shared& shared, int socket, std::string peer, std::shared_ptr<asio::ssl::context> tls)
      : shared_(shared),
        peer_(std::move(peer)),
        strand_(asio::make_strand(shared.context)),
        client_(make_stream(strand_, socket, std::move(tls))),
        pause_(strand_),
        guard_(shared.options.frames),
        bucket_(shared.options.of_connection, Clock::now()) {
    wait_until(Clock::now() + shared.options.first);
  }

  ~Connection() override {
    note_held_frames(0);
    note_sender(false);
    if (guard_.open_calls() > shared_.options.free_calls) shared_.charge(peer_, guard_.open_calls());
    {
      const base::MutexLock lock(shared_.mutex);
      shared_.connections.erase(this);
    }
    if (events_.ended) events_.ended();
  }

  void start(LineEvents events) override {
    events_ = std::move(events);
    asio::co_spawn(strand_, inward(shared_from_this()), asio::detached);
  }

  void hang_up() override {
    asio::post(strand_, [self = shared_from_this()] { self->close(); });
  }

  /// Its peer is late.
  void give_up() {
    asio::post(strand_, [self = shared_from_this()] {
      self->refuse(self->server_ == nullptr ? "it has said nothing"
                                            : "it takes nothing of what is sent to it");
    });
  }

  std::uint64_t answered() const override { return answered_; }

  bool is_late(Clock::time_point now) const { return now.time_since_epoch().count() >= deadline_; }

 private:
  void wait_until(Clock::time_point end) { deadline_ = end.time_since_epoch().count(); }

  void close() {
    client_->close();
    if (server_ != nullptr) server_->close();
    pause_.cancel();
  }

  void refuse(const std::string& why) {
    if (events_.refused) events_.refused(why);
    close();
  }

  /// From the client to gRPC.
  asio::awaitable<void> inward([[maybe_unused]] std::shared_ptr<Connection> self) {
    try {
      // Peers that hang up come again at once, and the beginning costs most, over TLS above all.
      const Clock::duration owed = shared_.charge(peer_, shared_.options.newcomer);
      co_await pause(std::min<Clock::duration>(owed, shared_.options.longest_welcome));
      if (client_->peer_has_ended()) co_return close();
      co_await client_->begin();
      bool more = true;
      while (more) more = co_await pass_inward();
      if (server_ != nullptr) {
        server_->end();  // gRPC hangs up then
        co_return;
      }
    } catch (const FrameFault& fault) {
      refuse(fault.what());
    } catch (const std::exception&) {
      // It has gone, or there is no memory for it.
    }
    close();
  }

  /// One piece; false at the end.
  asio::awaitable<bool> pass_inward() {
    co_await client_->wait();
    Piece piece(is_large_ ? kLargePieceBytes : kPieceBytes);
    const std::size_t got = co_await client_->read(piece.room());
    if (got == 0) co_return false;
    note_sender(got >= kPieceBytes);
    std::size_t cost = guard_.from_client(piece.first(got));
    note_held_frames(guard_.held_frames());
    // Answers pile up for a client that reads none, of which the shortest are bounded by nothing else.
    if (is_sending_) cost += static_cast<std::size_t>(guard_.calls() - calls_);
    calls_ = guard_.calls();
    co_await pause(due_after(cost));
    if (server_ == nullptr && guard_.begun()) connect();
    if (server_ == nullptr || !unsent_.empty()) unsent_.append(piece.first(got));
    if (server_ == nullptr) co_return true;
    if (unsent_.empty()) co_return co_await pass_to_server(piece.first(got));
    const std::string first = std::exchange(unsent_, {});
    co_return co_await pass_to_server(first);
  }

  /// False when gRPC has hung up: the client is still to hear what it has said before.
  asio::awaitable<bool> pass_to_server(std::string_view bytes) {
    try {
      co_await server_->write(asio::buffer(bytes));
      co_return true;
    } catch (const boost::system::system_error&) {
      co_return false;
    }
  }

  asio::awaitable<void> pause(Clock::duration wait) {
    if (wait == Clock::duration::zero()) co_return;
    pause_.expires_after(wait);
    co_await pause_.async_wait(use_awaitable);
  }

  /// How long the bytes just read must wait, with so many frames that make work.  What others of its peer, or
  /// all, have too much of does not concern a connection that itself asks for little.
  Clock::duration due_after(std::size_t frames) {
    Clock::duration own{}, shared{};
    if (frames > 0) {
      own = bucket_.take(static_cast<double>(frames), Clock::now());
      shared = shared_.charge(peer_, frames);
    }
    const RelayOptions& options = shared_.options;
    const bool asks_much = bucket_.taken(Clock::now()) > static_cast<double>(options.free_frames);
    if (!asks_much) shared = {};
    if (asks_much || guard_.open_calls() > options.free_calls) shared = std::max(shared, shared_.debt(peer_));
    return std::max(own, shared);
  }

  /// The connections that have most of what all have too much of must go.
  void note_held_frames(std::size_t frames) {
    const bool fewer = frames <= held_frames_;
    const std::size_t all = shared_.held_frames += frames - held_frames_;
    held_frames_ = frames;
    if (fewer || all <= shared_.options.held_frames) return;
    std::size_t connections = 1;
    {
      const base::MutexLock lock(shared_.mutex);
      connections += shared_.connections.size();
    }
    if (frames > shared_.options.held_frames / connections)
      throw FrameFault("too many frames of calls under way are held, and most of them are its own");
  }

  /// Whether it sends so much that its next piece should be large.
  void note_sender(bool large) {
    if (large == is_large_) return;
    if (large && shared_.large_senders.fetch_add(1) < kLargeSenders) {
      is_large_ = true;
    } else {
      --shared_.large_senders;
      is_large_ = false;
    }
  }

  /// The client has said the first words.
  void connect() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
      throw std::system_error(errno, std::generic_category(), "socketpair");
    try {
      server_ = make_stream(strand_, ends[0], nullptr);
    } catch (...) {
      ::close(ends[1]);
      throw;
    }
    wait_until(kNever);
    events_.begun(ends[1], client_->has_certificate());
    asio::co_spawn(strand_, outward(shared_from_this()), asio::detached);
  }

  /// From gRPC to the client, until gRPC hangs up.
  asio::awaitable<void> outward([[maybe_unused]] std::shared_ptr<Connection> self) {
    try {
      bool more = true;
      while (more) more = co_await pass_outward();
    } catch (const std::exception&) {
      // It has gone.
    }
    close();
  }

  asio::awaitable<bool> pass_outward() {
    co_await server_->wait();
    Piece piece(kPieceBytes);
    const std::size_t got = co_await server_->read(piece.room());
    if (got == 0) co_return false;
    guard_.from_server(piece.first(got));
    note_held_frames(guard_.held_frames());
    wait_until(Clock::now() + shared_.options.stall);
    is_sending_ = true;
    co_await client_->write(asio::buffer(piece.first(got)));
    is_sending_ = false;
    wait_until(kNever);
    answered_ = guard_.answered();
    co_return true;
  }

  Shared& shared_;
  const std::string peer_;
  const asio::strand<asio::io_context::executor_type> strand_;
  const std::unique_ptr<ByteStream> client_;
  std::unique_ptr<ByteStream> server_;  // the near end of the pair; null until the client has begun
  asio::steady_timer pause_;
  LineEvents events_;
  FrameGuard guard_;
  TokenBucket bucket_;
  std::string unsent_;  // less than the first words
  std::size_t held_frames_ = 0;
  std::uint64_t calls_ = 0;
  bool is_sending_ = false;
  bool is_large_ = false;  // sender
  std::atomic<std::uint64_t> answered_ = 0;
  std::atomic<Clock::rep> deadline_ = 0;
};

Relay::Relay(const RelayOptions& options) : shared_(std::make_unique<Shared>(options)) {
  const auto run = [&context = shared_->context] {
    for (;;) {
      try {
        context.run();
        return;
      } catch (const std::exception&) {
        // No memory for one connection: its end is noticed by its holder.
      }
    }
  };
  try {
    for (std::size_t i = 0; i < options.threads; ++i) shared_->threads.emplace_back(run);
  } catch (...) {
    stop();
    throw;
  }
}

Relay::~Relay() {
  stop();
}

std::shared_ptr<RelayLine> Relay::take(int socket, const std::string& peer,
                                       std::shared_ptr<asio::ssl::context> tls) {
  // A peer that is cut off is noticed by what it does not acknowledge; Unix sockets have no such option.
  const unsigned timeout_ms = static_cast<unsigned>(shared_->options.stall.count());
  setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &timeout_ms, sizeof timeout_ms);
  // Else megabytes of an input wait there before a short answer, such as that to a renewal, for minutes on a slow line.
  setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kMostUnsentBytes, sizeof kMostUnsentBytes);
  const auto connection = std::make_shared<Connection>(*shared_, socket, peer, std::move(tls));
  const base::MutexLock lock(shared_->mutex);
  shared_->connections.emplace(connection.get(), connection);
  return connection;
}

void Relay::tick() {
  std::vector<std::shared_ptr<Connection>> late;  // destroyed when the lock is gone
  const Clock::time_point now = Clock::now();
  {
    const base::MutexLock lock(shared_->mutex);
    // No peer could take anything while this process itself was stopped.
    if (now - shared_->ticked > kStandstill) shared_->awake = now;
    shared_->ticked = now;
    if (now - shared_->awake < kStandstill) return;
    for (const auto& [key, connection] : shared_->connections) {
      if (!key->is_late(now)) continue;
      if (auto alive = connection.lock()) late.push_back(std::move(alive));
    }
  }
  for (const auto& connection : late) connection->give_up();
}

void Relay::stop() {
  std::vector<std::shared_ptr<Connection>> all;
  {
    const base::MutexLock lock(shared_->mutex);
    for (const auto& [key, connection] : shared_->connections) {
      if (auto alive = connection.lock()) all.push_back(std::move(alive));
    }
  }
  for (const auto& connection : all) connection->hang_up();
  all.clear();
  shared_->work.reset();
  for (std::thread& thread : shared_->threads) {
    if (thread.joinable()) thread.join();
  }
}

}  // namespace affskel::server
