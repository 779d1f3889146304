#include "client/web/http_conversation.h"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <cctype>
#include <fstream>
#include <limits>
#include <sstream>

namespace affskel::client {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::use_awaitable;
using boost::system::error_code;
using boost::system::system_error;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 64 * 1024;
// Of what a refused peer still sends, so much is passed over, for so long.
constexpr std::uint64_t kPassedOver = 64 << 20;
constexpr std::chrono::milliseconds kPassingTime{2000};

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
class Pace {
 public:
  explicit Pace(const HttpLimits& limits) : limits_(limits) {}

  // @throws system_error timed_out
  void moved(std::size_t bytes) {
    bytes_ += bytes;
    const Clock::time_point now = Clock::now();
    if (now - begin_ < limits_.stretch) return;
    if (bytes_ < limits_.stretch_bytes) throw system_error(asio::error::timed_out);
    begin_ = now;
    bytes_ = 0;
  }

 private:
  const HttpLimits& limits_;
  Clock::time_point begin_ = Clock::now();
  std::uint64_t bytes_ = 0;
};

std::string lower(beast::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

using HeadParser = http::request_parser<http::empty_body>;

// Nothing when the target is malformed.
std::optional<HttpRequest> request_of(const HeadParser& parser, bool secure) {
  const auto& head = parser.get();
  auto target = parse_target(std::string_view(head.target().data(), head.target().size()));
  if (!target) return std::nullopt;
  HttpRequest request;
  request.method = std::string(head.method_string());
  request.path = std::move(target->path);
  request.query = std::move(target->query);
  for (const auto& field : head)
    request.headers.emplace_back(lower(field.name_string()), std::string(field.value()));
  request.secure = secure;
  return request;
}

HttpResponse plain(int status, const std::string& text) {
  return {status, {{"Content-Type", "text/plain; charset=utf-8"}}, text + "\n", {}, {}};
}

HttpResponse too_long(const std::string& what, std::uint64_t most) {
  return plain(413, "the body has " + what + " bytes; at most " + std::to_string(most) + " are taken");
}

std::string head_text(const HttpResponse& response, std::uint64_t bytes, bool keep_alive) {
  http::response<http::empty_body> message;
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

// One connection.  Every co_await is a statement of its own, without temporaries that have destructors: GCC
// 12 miscompiles co_await in conditions, and destroys such temporaries twice.
class Conversation {
 public:
  Conversation(HttpTransport& transport, const Conversations& shared)
      : transport_(transport), shared_(shared), limits_(shared.limits) {}

  asio::awaitable<void> run() {
    transport_.allow(limits_.header);
    co_await transport_.begin();
    bool goes_on = true;
    while (goes_on) goes_on = co_await one_request();
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
      if (error && error != http::error::need_more) break;
      if (head.is_header_done()) break;
      const std::size_t got = co_await fill();
      if (got == 0) co_return false;
    }
    if (error && error != http::error::need_more) {
      HttpResponse refusal = plain(400, "no HTTP request: " + error.message());
      if (error == http::error::header_limit) refusal = plain(431, "the headers are too long");
      co_await refuse(refusal);
      co_return false;
    }
    const bool goes_on = co_await answer(head);
    co_return goes_on;
  }

  asio::awaitable<bool> answer(HeadParser& head) {
    auto request = request_of(head, transport_.is_secure());
    if (!request) {
      const HttpResponse refusal = plain(400, "the request's target is malformed");
      co_await refuse(refusal);
      co_return false;
    }
    const bool bodiless = !head.chunked() && head.content_length().value_or(0) == 0;
    const bool keep_alive = head.keep_alive();
    auto admitted = shared_.admit(*request);
    if (auto* refusal = std::get_if<HttpResponse>(&admitted)) {
      if (bodiless) {
        co_await send(*refusal, keep_alive);
        co_return keep_alive;
      }
      co_await refuse(*refusal);
      co_return false;
    }
    Reception& reception = std::get<Reception>(admitted);
    if (head.content_length() && *head.content_length() > reception.max_bytes) {
      const HttpResponse refusal = too_long(std::to_string(*head.content_length()), reception.max_bytes);
      co_await refuse(refusal);
      co_return false;
    }
    if (!bodiless) {
      const bool whole = co_await receive(head, *request, reception);
      if (!whole) co_return false;
    }
    const HttpResponse response = co_await respond(*request, reception);
    co_await send(response, keep_alive);
    co_return keep_alive;
  }

  // False when the body cannot be taken, which is answered.
  asio::awaitable<bool> receive(HeadParser& head, HttpRequest& request, const Reception& reception) {
    if (lower(head.get()[http::field::expect]) == "100-continue") {
      co_await write("HTTP/1.1 100 Continue\r\n\r\n");
    }
    bool whole = true;
    if (reception.file.empty()) {
      http::request_parser<http::string_body> parser(std::move(head));
      whole = co_await read_body(parser, reception.max_bytes);
      if (whole) request.body = std::move(parser.get().body());
    } else {
      http::request_parser<http::file_body> parser(std::move(head));
      error_code error;
      parser.get().body().open(reception.file.c_str(), beast::file_mode::write, error);
      if (!error) whole = co_await read_body(parser, reception.max_bytes, error);
      if (error) {
        const HttpResponse refusal = plain(507, "there is no room for the file: " + error.message());
        co_await refuse(refusal);
        co_return false;
      }
    }
    if (whole) co_return true;
    const HttpResponse refusal = too_long("more", reception.max_bytes);
    co_await refuse(refusal);
    co_return false;
  }

  template <typename Parser>
  asio::awaitable<bool> read_body(Parser& parser, std::uint64_t max_bytes) {
    error_code error;
    const bool whole = co_await read_body(parser, max_bytes, error);
    if (error) throw system_error(error);
    co_return whole;
  }

  // False when the body is too long.  @param error of what takes it.
  template <typename Parser>
  asio::awaitable<bool> read_body(Parser& parser, std::uint64_t max_bytes, error_code& error) {
    parser.body_limit(max_bytes);
    parser.eager(true);
    Pace pace(limits_);
    while (!parser.is_done()) {
      if (buffer_.size() > 0) {
        buffer_.consume(parser.put(buffer_.data(), error));
        if (error == http::error::body_limit) {
          error = {};
          co_return false;
        }
        if (error && error != http::error::need_more) co_return true;
        if (!error) continue;
        error = {};
      }
      transport_.allow(limits_.stretch);
      const std::size_t got = co_await fill();
      if (got == 0) throw system_error(asio::error::eof);
      pace.moved(got);
    }
    co_return true;
  }

  asio::awaitable<HttpResponse> respond(const HttpRequest& request, const Reception& reception) {
    AnswerThreads& threads = shared_.threads[static_cast<std::size_t>(reception.kind)];
    if (threads.answers >= limits_.waiting) {
      HttpResponse busy = plain(503, "too many requests at a time; try again");
      busy.headers.emplace_back("Retry-After", "2");
      co_return busy;
    }
    transport_.allow_any_time();
    ++threads.answers;
    asio::awaitable<HttpResponse> answer_of = on_thread(request, reception);
    HttpResponse response = co_await asio::co_spawn(threads.pool, std::move(answer_of), use_awaitable);
    --threads.answers;
    co_return response;
  }

  static asio::awaitable<HttpResponse> on_thread(const HttpRequest& request, const Reception& reception) {
    co_return reception.respond(request);
  }

  // Ends the connection: what the peer still sends is passed over for a moment, so that it reads the answer.
  asio::awaitable<void> refuse(const HttpResponse& response) {
    co_await send(response, false);
    transport_.allow(std::min(limits_.stretch, kPassingTime));
    std::size_t got = 1;
    for (std::uint64_t passed = 0; got > 0 && passed < kPassedOver; passed += got) {
      buffer_.clear();
      got = co_await transport_.read(buffer_.prepare(kReadBytes));
    }
  }

  asio::awaitable<void> send(const HttpResponse& response, bool keep_alive) {
    if (response.file.empty()) {
      const std::string head = head_text(response, response.body.size(), keep_alive);
      co_await write(head);
      co_await write(response.body);
      co_return;
    }
    std::ifstream file(response.file, std::ios::binary | std::ios::ate);
    if (!file) {
      const HttpResponse gone = plain(410, "the file is not kept any more");
      co_await send(gone, keep_alive);
      co_return;
    }
    auto left = static_cast<std::uint64_t>(file.tellg());
    file.seekg(0);
    const std::string head = head_text(response, left, keep_alive);
    co_await write(head);
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
    Pace pace(limits_);
    while (!bytes.empty()) {
      transport_.allow(limits_.stretch);
      const std::size_t put = co_await transport_.write(asio::buffer(bytes.data(), bytes.size()));
      bytes.remove_prefix(put);
      pace.moved(put);
    }
  }

  HttpTransport& transport_;
  const Conversations& shared_;
  const HttpLimits& limits_;
  beast::flat_buffer buffer_;
};

}  // namespace

asio::awaitable<void> converse(HttpTransport& transport, const Conversations& shared) {
  Conversation conversation(transport, shared);
  co_await conversation.run();
}

}  // namespace affskel::client
