#include "http/conversation.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/lower_case.h"

namespace affskel::http {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace protocol = beast::http;
using asio::use_awaitable;
using boost::system::error_code;
using boost::system::system_error;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 64 * 1024;
// Of what a refused peer still sends, so much is passed over, for so long.
constexpr std::uint64_t kPassedOver = 64 << 20;
constexpr std::chrono::milliseconds kPassingTime{2000};
// Between looks whether the peer still waits for an answer.
constexpr std::chrono::milliseconds kLook{250};

// What every answer says unless it says otherwise: nothing is kept, guessed, embedded, run or told to others.
constexpr std::array<std::pair<const char*, const char*>, 6> kForAll = {{
    {"Cache-Control", "no-store"},
    {"Content-Security-Policy",
     "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"X-Content-Type-Options", "nosniff"},
}};

// Ends transfers that hardly move.
class PacedTransfer {
 public:
  explicit PacedTransfer(const Limits& limits) : pace_(limits.pace) {}

  // The peer's turn: it is to send or take something.
  void begin_turn() { pace_.turn(Clock::now()); }

  // It has.  @throws system_error timed_out
  void moved(std::size_t bytes) {
    pace_.moved(bytes, Clock::now());
    if (pace_.fell_short()) throw system_error(asio::error::timed_out);
  }

 private:
  base::Pace pace_;
};

std::string lower(beast::string_view text) {
  return base::lower_case({text.data(), text.size()});
}

using HeadParser = protocol::request_parser<protocol::empty_body>;

// Nothing when the target is malformed.
std::optional<Request> request_of(const HeadParser& parser, bool secure, const std::string& peer) {
  const auto& head = parser.get();
  auto target = parse_target(std::string_view(head.target().data(), head.target().size()));
  if (!target) return std::nullopt;
  Request request;
  request.method = std::string(head.method_string());
  request.path = std::move(target->path);
  request.query = std::move(target->query);
  for (const auto& field : head)
    request.headers.emplace_back(lower(field.name_string()), std::string(field.value()));
  request.secure = secure;
  request.peer = peer;
  return request;
}

Response plain(int status, const std::string& text) {
  return {status, {{"Content-Type", "text/plain; charset=utf-8"}}, text + "\n", {}, {}};
}

Response later(int status, const std::string& text) {
  Response response = plain(status, text);
  response.headers.emplace_back("Retry-After", "2");
  return response;
}

Response too_long(const std::string& what, std::uint64_t most) {
  return plain(413, "the body has " + what + " bytes; at most " + std::to_string(most) + " are taken");
}

std::string head_text(const Response& response, std::uint64_t bytes, bool keep_alive) {
  protocol::response<protocol::empty_body> message;
  message.version(11);
  message.result(static_cast<unsigned>(response.status));
  for (const auto& [name, value] : kForAll) message.set(name, value);
  for (const auto& [name, value] : response.headers) message.set(name, value);
  message.content_length(bytes);
  message.keep_alive(keep_alive);
  std::ostringstream text;
  text << message.base();
  return text.str();
}

// An answer that is being made; outlives the conversation where that breaks off.
struct Answering {
  Answering(const asio::any_io_executor& conversations, Request asked, Reception how)
      : request(std::move(asked)), reception(std::move(how)), ended(conversations) {}

  Request request;
  Reception reception;
  Response response;
  asio::steady_timer ended;  // this and the next belong to the conversations' thread
  bool is_there = false;
};

std::shared_ptr<AnswerThreads::Work> work_for(const std::shared_ptr<Answering>& answering) {
  const auto work = std::make_shared<AnswerThreads::Work>();
  // Strangers take turns by their addresses.
  work->whose = answering->reception.owner.empty() ? "peer " + answering->request.peer
                                                   : "owner " + answering->reception.owner;
  answering->request.gone = work->stop.get_token();
  work->run = [answering] {
    answering->response = answering->reception.respond(answering->request);
    answering->reception.respond = nullptr;  // and what it holds
    asio::post(answering->ended.get_executor(), [answering] {
      answering->is_there = true;
      answering->ended.cancel();
    });
  };
  return work;
}

// One connection.  Every co_await is a statement of its own, without temporaries that have destructors: GCC
// 12 miscompiles co_await in conditions, and destroys such temporaries twice.
class Conversation {
 public:
  Conversation(Transport& transport, Places::Place& place, const std::string& peer,
               const Conversations& shared)
      : transport_(transport), place_(place), peer_(peer), shared_(shared), limits_(shared.limits) {}

  asio::awaitable<void> run() {
    transport_.allow(limits_.header);
    co_await transport_.begin();
    bool goes_on = true;
    while (goes_on) {
      goes_on = co_await one_request();
      if (goes_on) place_.idles();
    }
    transport_.allow(limits_.header);
    co_await transport_.end();
  }

 private:
  // Some more bytes into the buffer; none when the peer has ended.
  asio::awaitable<std::size_t> fill() {
    const std::size_t got = co_await transport_.read(buffer_.prepare(kReadBytes));
    buffer_.commit(got);
    co_return got;
  }

  // Whether another may follow.
  asio::awaitable<bool> one_request() {
    bodiless_ = false;
    transport_.allow(limits_.idle);
    if (buffer_.size() == 0) {
      const std::size_t got = co_await fill();
      if (got == 0) co_return false;
    }
    HeadParser head;
    head.header_limit(limits_.header_bytes);
    // None at all would refuse every body in Beast 1.74; see read_body.
    head.body_limit(std::numeric_limits<std::uint64_t>::max());
    transport_.allow(limits_.header);
    error_code error;
    while (!head.is_header_done()) {
      buffer_.consume(head.put(buffer_.data(), error));
      if (error && error != protocol::error::need_more) break;
      if (head.is_header_done()) break;
      const std::size_t got = co_await fill();
      if (got == 0) co_return false;
    }
    if (error && error != protocol::error::need_more) {
      Response refusal = plain(400, "no HTTP request: " + error.message());
      if (error == protocol::error::header_limit) refusal = plain(431, "the headers are too long");
      co_await refuse(refusal);
      co_return false;
    }
    const bool goes_on = co_await answer(head);
    co_return goes_on;
  }

  asio::awaitable<bool> answer(HeadParser& head) {
    place_.transfers();
    bodiless_ = head.get().method() == protocol::verb::head;
    auto request = request_of(head, transport_.is_secure(), peer_);
    if (!request) {
      const Response refusal = plain(400, "the request's target is malformed");
      co_await refuse(refusal);
      co_return false;
    }
    const bool is_whole = !head.chunked() && head.content_length().value_or(0) == 0;
    const bool keep_alive = head.keep_alive();
    auto admitted = shared_.admit(*request);
    if (auto* refusal = std::get_if<Response>(&admitted)) {
      if (is_whole) {
        co_await send(*refusal, keep_alive);
        co_return keep_alive;
      }
      co_await refuse(*refusal);
      co_return false;
    }
    Reception& reception = std::get<Reception>(admitted);
    if (!place_.belongs_to(reception.owner)) {
      const Response refusal = later(429, "you have too many connections at a time");
      co_await refuse(refusal);
      co_return false;
    }
    if (head.content_length() && *head.content_length() > reception.max_bytes) {
      const Response refusal = too_long(std::to_string(*head.content_length()), reception.max_bytes);
      co_await refuse(refusal);
      co_return false;
    }
    if (!is_whole || !reception.file.empty()) {  // an empty file is one, too
      const bool whole = co_await receive(head, *request, reception);
      if (!whole) co_return false;
    }
    const Response response = co_await respond(*request, reception);
    co_await send(response, keep_alive);
    co_return keep_alive;
  }

  // False when the body cannot be taken, which is answered.
  asio::awaitable<bool> receive(HeadParser& head, Request& request, const Reception& reception) {
    if (lower(head.get()[protocol::field::expect]) == "100-continue") {
      co_await write("HTTP/1.1 100 Continue\r\n\r\n");
    }
    std::optional<Response> refusal;
    if (reception.file.empty()) {
      protocol::request_parser<protocol::string_body> parser(std::move(head));
      auto fault = co_await read_body(parser, reception.max_bytes);
      refusal = std::move(fault);
      if (!refusal) request.body = std::move(parser.get().body());
    } else {
      protocol::request_parser<protocol::file_body> parser(std::move(head));
      error_code error;
      parser.get().body().open(reception.file.c_str(), beast::file_mode::write, error);
      if (error) {
        refusal = no_room(error);
      } else {
        auto fault = co_await read_body(parser, reception.max_bytes);
        refusal = std::move(fault);
      }
    }
    if (!refusal) co_return true;
    co_await refuse(*refusal);
    co_return false;
  }

  // Nothing when the body is whole, or why it cannot be taken.
  template <typename Parser>
  asio::awaitable<std::optional<Response>> read_body(Parser& parser, std::uint64_t max_bytes) {
    parser.body_limit(max_bytes);
    parser.eager(true);
    PacedTransfer transfer(limits_);
    std::uint64_t taken = 0;
    error_code error;
    while (!parser.is_done()) {
      if (buffer_.size() > 0) {
        const std::size_t some = parser.put(buffer_.data(), error);
        buffer_.consume(some);
        taken += some;
        if (error && error != protocol::error::need_more) co_return refusal_of(error, max_bytes);
        // What frames the content counts, too.
        if (taken > limits_.header_bytes && taken - limits_.header_bytes > max_bytes)
          co_return too_long("more", max_bytes);
        if (!error) continue;
        // The parser keeps a chunk's size line and the trailers until they end.
        if (buffer_.size() > limits_.header_bytes)
          co_return plain(431, "a chunk's extensions or trailers are too long");
      }
      transport_.allow(limits_.pace.window);
      transfer.begin_turn();
      const std::size_t got = co_await fill();
      if (got == 0) throw system_error(asio::error::eof);
      transfer.moved(got);
    }
    co_return std::nullopt;
  }

  static Response no_room(const error_code& error) {
    return plain(507, "there is no room for the file: " + error.message());
  }

  static Response refusal_of(const error_code& error, std::uint64_t max_bytes) {
    if (error == protocol::error::body_limit) return too_long("more", max_bytes);
    if (error == protocol::error::header_limit) return plain(431, "the trailers are too long");
    const auto& of_protocol = protocol::make_error_code(protocol::error::need_more).category();
    if (error.category() == of_protocol) return plain(400, "malformed body: " + error.message());
    return no_room(error);
  }

  asio::awaitable<Response> respond(Request& request, Reception& reception) {
    AnswerThreads& threads = shared_.threads[static_cast<std::size_t>(reception.kind)];
    const bool drops = reception.kind != AnswerKind::kQuick;
    const auto executor = co_await asio::this_coro::executor;
    const auto answering = std::make_shared<Answering>(executor, std::move(request), std::move(reception));
    const auto work = work_for(answering);
    if (!threads.add(work)) co_return later(503, "too many requests at a time; try again");
    place_.works();
    transport_.allow_any_time();
    error_code ignored;
    while (!answering->is_there) {
      answering->ended.expires_after(kLook);
      co_await answering->ended.async_wait(asio::redirect_error(use_awaitable, ignored));
      if (!answering->is_there && drops && transport_.has_peer_gone()) {
        threads.drop(work);
        throw system_error(asio::error::eof);
      }
    }
    place_.transfers();
    co_return std::move(answering->response);
  }

  // Ends the connection: what the peer still sends is passed over for a moment, so that it reads the answer.
  asio::awaitable<void> refuse(const Response& response) {
    co_await send(response, false);
    transport_.allow(std::min(limits_.pace.window, kPassingTime));
    std::size_t got = 1;
    for (std::uint64_t passed = 0; got > 0 && passed < kPassedOver; passed += got) {
      buffer_.clear();
      got = co_await transport_.read(buffer_.prepare(kReadBytes));
    }
  }

  asio::awaitable<void> send(const Response& response, bool keep_alive) {
    if (response.file.empty()) {
      const std::string head = head_text(response, response.body.size(), keep_alive);
      co_await write(head);
      if (!bodiless_) co_await write(response.body);
      co_return;
    }
    std::ifstream file(response.file, std::ios::binary | std::ios::ate);
    if (!file) {
      const Response gone = plain(410, "the file is not kept any more");
      co_await send(gone, keep_alive);
      co_return;
    }
    auto left = static_cast<std::uint64_t>(file.tellg());
    file.seekg(0);
    const std::string head = head_text(response, left, keep_alive);
    co_await write(head);
    if (bodiless_) co_return;
    std::string piece(kReadBytes, '\0');
    while (left > 0) {
      const auto some = static_cast<std::streamsize>(std::min<std::uint64_t>(left, kReadBytes));
      if (!file.read(piece.data(), some)) throw system_error(asio::error::eof);
      const std::string_view bytes(piece.data(), static_cast<std::size_t>(some));
      co_await write(bytes);
      left -= static_cast<std::uint64_t>(some);
    }
  }

  asio::awaitable<void> write(std::string_view bytes) {
    PacedTransfer transfer(limits_);
    while (!bytes.empty()) {
      transport_.allow(limits_.pace.window);
      transfer.begin_turn();
      const std::size_t put = co_await transport_.write(asio::buffer(bytes.data(), bytes.size()));
      bytes.remove_prefix(put);
      transfer.moved(put);
    }
  }

  Transport& transport_;
  Places::Place& place_;
  const std::string& peer_;
  const Conversations& shared_;
  const Limits& limits_;
  beast::flat_buffer buffer_;
  bool bodiless_ = false;  // the answer, as of HEAD
};

}  // namespace

asio::awaitable<void> converse(Transport& transport, Places::Place& place, const std::string& peer,
                               const Conversations& shared) {
  Conversation conversation(transport, place, peer, shared);
  co_await conversation.run();
}

}  // namespace affskel::http
