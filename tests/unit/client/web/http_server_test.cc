#include "client/web/http_server.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "client/base/error.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"
#include "web/http_peer.h"

namespace affskel::client {
namespace {

using Admitted = std::variant<HttpResponse, Reception>;

HttpResponse text(const std::string& body) {
  return {200, {{"Content-Type", "text/plain"}}, body, {}, {}};
}

// Takes bodies of at most so many bytes and answers with what came.
AdmitRequest echo(std::uint64_t max_bytes) {
  return [max_bytes](const HttpRequest&) -> Admitted {
    Reception reception;
    reception.max_bytes = max_bytes;
    reception.respond = [](const HttpRequest& request) {
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
  HttpPeer peer(server.port());
  ASSERT_TRUE(peer.send(get("/a%20b?q=1%2B1+x")));
  EXPECT_EQ(peer.read().body, "GET /a b 1+1 x ");
  ASSERT_TRUE(peer.send(post("body") + get("/next")));  // both at once
  EXPECT_EQ(peer.read().body, "POST /p  body");
  EXPECT_EQ(peer.read().body, "GET /next  ");
}

TEST(HttpServer, EveryAnswerForbidsWhatItDoesNotAllow) {
  RunningServer server(echo(100));
  HttpPeer peer(server.port());
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
  HttpPeer peer(server.port());
  ASSERT_TRUE(
      peer.send("POST /p HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
                "3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n"));
  EXPECT_EQ(peer.read().body, "POST /p  abcde");
}

TEST(HttpServer, RefusesLongBodies) {
  RunningServer server(echo(10));
  {
    HttpPeer announced(server.port());
    ASSERT_TRUE(announced.send("POST /p HTTP/1.1\r\nHost: localhost\r\nContent-Length: 11\r\n\r\n"));
    const PeerAnswer answer = announced.read();
    EXPECT_EQ(answer.status, 413);
    EXPECT_NE(answer.body.find("11 bytes; at most 10"), std::string::npos) << answer.body;
    announced.wait_for_end();
  }
  HttpPeer chunked(server.port());
  ASSERT_TRUE(
      chunked.send("POST /p HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
                   "b\r\n01234567890\r\n0\r\n\r\n"));
  EXPECT_EQ(chunked.read().status, 413);
  HttpPeer exact(server.port());
  ASSERT_TRUE(exact.send(post("0123456789")));
  EXPECT_EQ(exact.read().status, 200);
}

TEST(HttpServer, RefusesLongHeadersAndWhatIsNoHttp) {
  RunningServer server(echo(10));
  HttpPeer long_headers(server.port());
  long_headers.send(get("/", "X: " + std::string(20000, 'x') + "\r\n"));
  EXPECT_EQ(long_headers.read().status, 431);
  HttpPeer nonsense(server.port());
  nonsense.send("\x16\x03\x01 no http\r\n\r\n");
  EXPECT_EQ(nonsense.read().status, 400);
  HttpPeer malformed(server.port());
  malformed.send(get("/%zz"));
  EXPECT_EQ(malformed.read().status, 400);
}

HttpLimits impatient() {
  HttpLimits limits;
  limits.header = limits.idle = limits.stretch = std::chrono::milliseconds(100);
  return limits;
}

TEST(HttpServer, EndsConnectionsThatSayNothingOrTooLittle) {
  RunningServer server(echo(1 << 20), impatient());
  HttpPeer silent(server.port());
  silent.wait_for_end();
  HttpPeer half(server.port());
  ASSERT_TRUE(half.send("GET / HTT"));
  half.wait_for_end();
  HttpPeer body(server.port());
  ASSERT_TRUE(body.send("POST /p HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\nabc"));
  body.wait_for_end();
}

// Each read succeeds within its time: what ends the transfer is that it hardly moves.
TEST(HttpServer, EndsBodiesThatDrip) {
  HttpLimits limits;
  limits.stretch = std::chrono::milliseconds(100);
  limits.stretch_bytes = std::uint64_t{1} << 40;
  RunningServer server(echo(std::uint64_t{1} << 30), limits);
  HttpPeer peer(server.port());
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
      [&](const HttpRequest&) -> Admitted {
        HttpResponse response = text(std::string(64 << 20, 'x'));
        response.held = std::shared_ptr<void>(nullptr, [&](void*) {
          const std::lock_guard lock(mutex);
          freed = true;
          gone.notify_all();
        });
        return response;
      },
      impatient());
  HttpPeer peer(server.port());
  ASSERT_TRUE(peer.send(get("/")));
  std::unique_lock lock(mutex);
  gone.wait(lock, [&] { return freed; });
}

TEST(HttpServer, BodiesAndAnswersMayBeFiles) {
  tests::TemporaryDirectory dir;
  const std::string content(300000, 'y');
  RunningServer server([&](const HttpRequest&) -> Admitted {
    Reception reception;
    reception.max_bytes = 1 << 20;
    reception.file = dir / "got";
    reception.respond = [&](const HttpRequest& request) {
      EXPECT_TRUE(request.body.empty());
      HttpResponse response;
      response.file = dir / "got";
      return response;
    };
    return reception;
  });
  HttpPeer peer(server.port());
  ASSERT_TRUE(peer.send(post(content)));
  EXPECT_EQ(peer.read().body, content);
  EXPECT_EQ(tests::read_file(dir / "got"), content);
}

TEST(HttpServer, AnswersInTimeOrNotAtAll) {
  std::mutex mutex;
  std::condition_variable changed;
  bool open = false;
  HttpLimits limits;
  limits.threads = {1, 1, 1};
  limits.waiting = 2;
  RunningServer server(
      [&](const HttpRequest& head) -> Admitted {
        Reception reception;
        reception.kind = head.path == "/slow" ? AnswerKind::kAwaited : AnswerKind::kQuick;
        reception.respond = [&](const HttpRequest& request) {
          if (request.path == "/slow") {
            std::unique_lock lock(mutex);
            changed.wait(lock, [&] { return open; });
          }
          return text("done");
        };
        return reception;
      },
      limits);
  HttpPeer first(server.port()), second(server.port()), third(server.port()), quick(server.port());
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
  for (HttpPeer* peer : {&first, &second, &third}) ++statuses.emplace(peer->read().status, 0)->second;
  EXPECT_EQ(statuses.count(200), 2u);
  EXPECT_EQ(statuses.count(503), 1u);
}

TEST(HttpServer, ClosesConnectionsBeyondTheLimit) {
  HttpLimits limits;
  limits.connections = 2;
  RunningServer server(echo(10), limits);
  HttpPeer first(server.port());
  ASSERT_TRUE(first.send(get("/")));
  EXPECT_EQ(first.read().status, 200);
  {
    HttpPeer second(server.port());
    ASSERT_TRUE(second.send(get("/")));
    EXPECT_EQ(second.read().status, 200);
    HttpPeer third(server.port());
    third.wait_for_end();
  }
  // The place of one that ended is given again, once its end was seen.
  for (int status = 0; status != 200;) {
    HttpPeer next(server.port());
    next.send(get("/"));
    status = next.read().status;
  }
}

TEST(HttpServer, SaysWhereItCannotListen) {
  RunningServer server(echo(10));
  wire::Address taken;
  taken.host = "127.0.0.1";
  taken.port = server.port();
  try {
    const HttpServer second(taken, nullptr, echo(10));
    FAIL() << "two servers on one port";
  } catch (const ClientError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find(std::to_string(server.port())), std::string::npos);
  }
}

}  // namespace
}  // namespace affskel::client
