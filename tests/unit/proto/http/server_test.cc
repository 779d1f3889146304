#include "http/server.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <vector>

#include "tools/files.h"
#include "tools/http_peer.h"
#include "tools/temporary_directory.h"

namespace affskel::http {
namespace {

using Admitted = std::variant<Response, Reception>;

Response text(const std::string& body) {
  return {200, {{"Content-Type", "text/plain"}}, body, {}, {}};
}

// Takes bodies of at most so many bytes and answers with what came.
AdmitRequest echo(std::uint64_t max_bytes) {
  return [max_bytes](const Request&) -> Admitted {
    Reception reception;
    reception.max_bytes = max_bytes;
    reception.respond = [](const Request& request) {
      return text(request.method + " " + request.path + " " + request.parameter("q") + " " + request.body);
    };
    return reception;
  };
}

std::string post(const std::string& body, const std::string& more_headers = "") {
  return "POST /p HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
         more_headers + "\r\n" + body;
}

TEST(HttpServer, AnswersOneRequestAfterTheOther) {
  RunningServer server(echo(100));
  Peer peer(server.port());
  ASSERT_TRUE(peer.send(get("/a%20b?q=1%2B1+x")));
  EXPECT_EQ(peer.read().body, "GET /a b 1+1 x ");
  ASSERT_TRUE(peer.send(post("body") + get("/next")));  // both at once
  EXPECT_EQ(peer.read().body, "POST /p  body");
  EXPECT_EQ(peer.read().body, "GET /next  ");
}

TEST(HttpServer, EveryAnswerForbidsWhatItDoesNotAllow) {
  RunningServer server(echo(100));
  Peer peer(server.port());
  ASSERT_TRUE(peer.send(get("/")));
  const PeerAnswer answer = peer.read();
  EXPECT_EQ(answer.headers.at("cache-control"), "no-store");
  EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
  EXPECT_EQ(answer.headers.at("referrer-policy"), "no-referrer");
  EXPECT_EQ(answer.headers.at("cross-origin-resource-policy"), "same-origin");
  EXPECT_TRUE(answer.headers.at("content-security-policy").starts_with("default-src 'none'"));
}

TEST(HttpServer, TakesChunkedBodies) {
  RunningServer server(echo(100));
  Peer peer(server.port());
  ASSERT_TRUE(
      peer.send("POST /p HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
                "3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n"));
  EXPECT_EQ(peer.read().body, "POST /p  abcde");
}

TEST(HttpServer, RefusesLongBodies) {
  RunningServer server(echo(10));
  {
    Peer announced(server.port());
    ASSERT_TRUE(announced.send("POST /p HTTP/1.1\r\nHost: localhost\r\nContent-Length: 11\r\n\r\n"));
    const PeerAnswer answer = announced.read();
    EXPECT_EQ(answer.status, 413);
    EXPECT_NE(answer.body.find("11 bytes; at most 10"), std::string::npos) << answer.body;
    announced.wait_for_end();
  }
  Peer chunked(server.port());
  ASSERT_TRUE(
      chunked.send("POST /p HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
                   "b\r\n01234567890\r\n0\r\n\r\n"));
  EXPECT_EQ(chunked.read().status, 413);
  Peer exact(server.port());
  ASSERT_TRUE(exact.send(post("0123456789")));
  EXPECT_EQ(exact.read().status, 200);
}

TEST(HttpServer, RefusesLongHeadersAndWhatIsNoHttp) {
  RunningServer server(echo(10));
  Peer long_headers(server.port());
  long_headers.send(get("/", "X: " + std::string(20000, 'x') + "\r\n"));
  EXPECT_EQ(long_headers.read().status, 431);
  Peer nonsense(server.port());
  nonsense.send("\x16\x03\x01 no http\r\n\r\n");
  EXPECT_EQ(nonsense.read().status, 400);
  Peer malformed(server.port());
  malformed.send(get("/%zz"));
  EXPECT_EQ(malformed.read().status, 400);
}

std::string chunked(const std::string& chunks) {
  return "POST /p HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n" + chunks;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

// Taken into memory by one server, into a file by the other.
TEST(HttpServer, AllBytesOfABodyCount) {
  tests::TemporaryDirectory dir;
  const auto to_file = [&](const Request& head) {
    Admitted admitted = echo(1000)(head);
    std::get<Reception>(admitted).file = dir / "body";
    return admitted;
  };
  for (const AdmitRequest& admit : {echo(1000), AdmitRequest(to_file)}) {
    RunningServer server(admit);
    const auto status = [&](const std::string& chunks) {
      Peer peer(server.port());
      peer.send(chunked(chunks));
      return peer.read().status;
    };
    EXPECT_EQ(status("1;" + std::string(1 << 20, 'x')), 431) << "an extension";
    EXPECT_EQ(status("1\r\nx\r\n0\r\n" + repeated("X: y\r\n", 100000)), 431) << "trailers";
    EXPECT_EQ(status("1\r\nx\r\n0\r\nX: " + std::string(1 << 20, 'x')), 431) << "a trailer";
    EXPECT_EQ(status(repeated("1;" + std::string(1000, 'x') + "\r\nx\r\n", 100)), 413) << "extensions";
    EXPECT_EQ(status(repeated("1\r\nx\r\n", 900) + "0\r\n\r\n"), 200) << "small chunks";
  }
}

TEST(HttpServer, MalformedBodiesAreTheClientsFault) {
  tests::TemporaryDirectory dir;
  const auto to_file = [&](const Request& head) {
    Admitted admitted = echo(1000)(head);
    std::get<Reception>(admitted).file = dir / (head.parameter("q") + "body");
    return admitted;
  };
  for (const AdmitRequest& admit : {echo(1000), AdmitRequest(to_file)}) {
    RunningServer server(admit);
    for (const char* chunks : {"zz\r\n", "-1\r\n", "1\r\nxyz\r\n", "\r\n\r\n", "fffffffffffffffff\r\n"}) {
      Peer peer(server.port());
      peer.send(chunked(chunks));
      EXPECT_EQ(peer.read().status, 400) << chunks;
    }
  }
}

TEST(HttpServer, HeadHasNoBody) {
  RunningServer server(echo(10));
  Peer peer(server.port());
  ASSERT_TRUE(peer.send("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n" + get("/next")));
  EXPECT_EQ(peer.read_head().headers.at("content-length"), "8");
  EXPECT_EQ(peer.read().body, "GET /next  ");
}

Limits impatient() {
  Limits limits;
  limits.header = limits.idle = limits.pace.window = std::chrono::milliseconds(100);
  return limits;
}

TEST(HttpServer, EndsConnectionsThatSayNothingOrTooLittle) {
  RunningServer server(echo(1 << 20), impatient());
  Peer silent(server.port());
  silent.wait_for_end();
  Peer half(server.port());
  ASSERT_TRUE(half.send("GET / HTT"));
  half.wait_for_end();
  Peer body(server.port());
  ASSERT_TRUE(body.send("POST /p HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\nabc"));
  body.wait_for_end();
}

// Each read succeeds within its time: what ends the transfer is that it hardly moves.
TEST(HttpServer, EndsBodiesThatDrip) {
  Limits limits;
  limits.pace.window = std::chrono::milliseconds(100);
  limits.pace.least_per_s = std::uint64_t{1} << 44;
  RunningServer server(echo(std::uint64_t{1} << 30), limits);
  Peer peer(server.port());
  ASSERT_TRUE(peer.send("POST /p HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100000000\r\n\r\n"));
  while (peer.send("x")) {
  }
}

// An answer larger than all buffers, which the peer does not read.
TEST(HttpServer, EndsAnswersThatNobodyReads) {
  std::mutex mutex;
  std::condition_variable gone;
  bool freed = false;
  RunningServer server(
      [&](const Request&) -> Admitted {
        Response response = text(std::string(64 << 20, 'x'));
        response.held = std::shared_ptr<void>(nullptr, [&](void*) {
          const std::lock_guard lock(mutex);
          freed = true;
          gone.notify_all();
        });
        return response;
      },
      impatient());
  Peer peer(server.port());
  ASSERT_TRUE(peer.send(get("/")));
  std::unique_lock lock(mutex);
  gone.wait(lock, [&] { return freed; });
}

TEST(HttpServer, BodiesAndAnswersMayBeFiles) {
  tests::TemporaryDirectory dir;
  const std::string content(300000, 'y');
  RunningServer server([&](const Request&) -> Admitted {
    Reception reception;
    reception.max_bytes = 1 << 20;
    reception.file = dir / "got";
    reception.respond = [&](const Request& request) {
      EXPECT_TRUE(request.body.empty());
      Response response;
      response.file = dir / "got";
      return response;
    };
    return reception;
  });
  Peer peer(server.port());
  ASSERT_TRUE(peer.send(post(content)));
  EXPECT_EQ(peer.read().body, content);
  EXPECT_EQ(tests::read_file(dir / "got"), content);
}

TEST(HttpServer, AnswersInTimeOrNotAtAll) {
  std::mutex mutex;
  std::condition_variable changed;
  bool open = false;
  Limits limits;
  limits.threads = {{{1, 1}, {1, 1}, {1, 1}}};
  limits.waiting = 2;
  RunningServer server(
      [&](const Request& head) -> Admitted {
        Reception reception;
        reception.kind = head.path == "/slow" ? AnswerKind::kAwaited : AnswerKind::kQuick;
        reception.respond = [&](const Request& request) {
          if (request.path == "/slow") {
            std::unique_lock lock(mutex);
            changed.wait(lock, [&] { return open; });
          }
          return text("done");
        };
        return reception;
      },
      limits);
  Peer first(server.port()), second(server.port()), third(server.port()), quick(server.port());
  ASSERT_TRUE(first.send(get("/slow")));
  ASSERT_TRUE(second.send(get("/slow")));
  // One of the three finds the queue full; which one is open.
  ASSERT_TRUE(third.send(get("/slow")));
  ASSERT_TRUE(quick.send(get("/")));
  EXPECT_EQ(quick.read().status, 200) << "other kinds have threads of their own";
  {
    const std::lock_guard lock(mutex);
    open = true;
    changed.notify_all();
  }
  std::multimap<int, int> statuses;
  for (Peer* peer : {&first, &second, &third}) ++statuses.emplace(peer->read().status, 0)->second;
  EXPECT_EQ(statuses.count(200), 2u);
  EXPECT_EQ(statuses.count(503), 1u);
}

TEST(HttpServer, TheSilentGiveWay) {
  Limits limits;
  limits.places = {.connections = 4, .for_known = 0};
  RunningServer server(echo(10), limits);
  std::vector<std::unique_ptr<Peer>> silent;
  for (int i = 0; i < 20; ++i) {
    silent.push_back(std::make_unique<Peer>(server.port()));
    if (i % 2 == 0) silent.back()->send("GET / HT");
    Peer honest(server.port());
    ASSERT_TRUE(honest.send(get("/")));
    EXPECT_EQ(honest.read().status, 200);
  }
  silent.front()->wait_for_end();
}

// Tells when it is destroyed, or told to.
class Bell {
 public:
  void ring() {
    const std::lock_guard lock(mutex_);
    rung_ = true;
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return rung_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool rung_ = false;
};

TEST(HttpServer, DropsAnswersWhosePeerHasGone) {
  Bell begun, stopped, forgotten;
  Limits limits;
  limits.threads = {{{1, 1}, {1, 1}, {1, 1}}};
  RunningServer server(
      [&](const Request& head) -> Admitted {
        Reception reception;
        reception.kind = AnswerKind::kComputed;
        std::shared_ptr<void> held;
        if (head.path == "/second") held = std::shared_ptr<void>(nullptr, [&](void*) { forgotten.ring(); });
        reception.respond = [&, held](const Request& request) {
          EXPECT_EQ(request.path, "/first") << "nobody waited for it";
          begun.ring();
          Bell gone;
          const std::stop_callback ring(request.gone, [&] { gone.ring(); });
          gone.wait();
          stopped.ring();
          return text("");
        };
        return reception;
      },
      limits);
  auto first = std::make_unique<Peer>(server.port());
  ASSERT_TRUE(first->send(get("/first")));
  begun.wait();
  auto second = std::make_unique<Peer>(server.port());
  ASSERT_TRUE(second->send(get("/second")));
  second.reset();
  forgotten.wait();  // while the first is under way
  first.reset();
  stopped.wait();
}

TEST(HttpServer, OnePersonHasAShareOfTheConnections) {
  Limits limits;
  limits.places.of_owner = 1;
  Bell begun, open;
  RunningServer server(
      [&](const Request&) -> Admitted {
        Reception reception;
        reception.owner = "ada";
        reception.respond = [&](const Request&) {
          begun.ring();
          open.wait();
          return text("done");
        };
        return reception;
      },
      limits);
  Peer first(server.port()), second(server.port());
  ASSERT_TRUE(first.send(get("/")));
  begun.wait();
  ASSERT_TRUE(second.send(get("/")));
  EXPECT_EQ(second.read().status, 429);
  open.ring();
  EXPECT_EQ(first.read().status, 200);
}

TEST(HttpServer, KeepsIgnoringWhatItsStarterIgnored) {
  const auto before = signal(SIGHUP, SIG_IGN);  // as nohup
  {
    RunningServer server(echo(100), {}, {}, true);
    Peer peer(server.port());
    ASSERT_TRUE(peer.send(get("/")));
    EXPECT_EQ(peer.read().status, 200);  // so it hears signals by now
    struct sigaction hangup {
    }, interrupt{};
    sigaction(SIGHUP, nullptr, &hangup);
    sigaction(SIGINT, nullptr, &interrupt);
    EXPECT_EQ(hangup.sa_handler, SIG_IGN);
    EXPECT_NE(interrupt.sa_handler, SIG_DFL);
  }
  signal(SIGHUP, before);
}

TEST(HttpServer, SaysWhereItCannotListen) {
  RunningServer server(echo(10));
  wire::Address taken;
  taken.host = "127.0.0.1";
  taken.port = server.port();
  try {
    const Server second(taken, nullptr, echo(10));
    FAIL() << "two servers on one port";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::address_in_use);
  }
}

}  // namespace
}  // namespace affskel::http
