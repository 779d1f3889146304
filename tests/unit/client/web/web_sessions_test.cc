#include "client/web/web_sessions.h"

#include <gtest/gtest.h>

#include "client/web/cookie.h"
#include "client/web/shelf.h"
#include "http/message.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using namespace std::chrono_literals;
using Clock = WebSessions::Clock;

WebUser user(const std::string& owner) {
  return {std::make_shared<const base::MemoryFile>("token", "token of " + owner), owner, false, 1000};
}

struct Sessions {
  Clock::time_point now{};
  WebSessions sessions{{4, 2, std::chrono::hours(1), std::chrono::hours(3)}, [this] { return now; }};
};

TEST(WebSessions, AreFoundByTheirSecretAlone) {
  Sessions s;
  const auto ada = s.sessions.begin(user("ada")), bob = s.sessions.begin(user("bob"));
  ASSERT_TRUE(ada && bob);
  EXPECT_NE(*ada, *bob);
  EXPECT_EQ(s.sessions.find(*ada)->user.owner, "ada");
  EXPECT_EQ(tests::read_file(s.sessions.find(*bob)->user.token->path()), "token of bob");
  EXPECT_FALSE(s.sessions.find(""));
  EXPECT_FALSE(s.sessions.find(s.sessions.find(*ada)->id)) << "the name of a session is no secret";
  s.sessions.end(s.sessions.find(*ada)->id);
  EXPECT_FALSE(s.sessions.find(*ada));
  EXPECT_TRUE(s.sessions.find(*bob));
}

TEST(WebSessions, EndWhenUnusedAndAtLast) {
  Sessions s;
  const auto secret = s.sessions.begin(user("ada"));
  for (int i = 0; i < 3; ++i) {
    s.now += 59min;
    EXPECT_TRUE(s.sessions.find(*secret)) << i;
  }
  s.now += 4min;  // three hours and a minute in all
  EXPECT_FALSE(s.sessions.find(*secret));
  const auto unused = s.sessions.begin(user("ada"));
  s.now += 61min;
  EXPECT_FALSE(s.sessions.find(*unused));
}

TEST(WebSessions, AreBounded) {
  Sessions s;
  const auto first = s.sessions.begin(user("ada")), second = s.sessions.begin(user("ada"));
  s.now += 1min;
  EXPECT_TRUE(s.sessions.find(*first));
  s.now += 1min;
  const auto third = s.sessions.begin(user("ada"));
  EXPECT_TRUE(s.sessions.find(*first));
  EXPECT_FALSE(s.sessions.find(*second)) << "the longest unused of the owner";
  EXPECT_TRUE(s.sessions.find(*third));
  EXPECT_TRUE(s.sessions.begin(user("bob")));
  EXPECT_TRUE(s.sessions.begin(user("cyd")));
  EXPECT_FALSE(s.sessions.begin(user("dan"))) << "four are all";
  EXPECT_TRUE(s.sessions.find(*first)) << "nobody else's session makes room";
}

TEST(WebSessions, KeysOpenOnce) {
  WebSessions sessions;
  const std::string key = sessions.new_key(), other = sessions.new_key();
  EXPECT_EQ(key.size(), 64u);
  EXPECT_FALSE(sessions.use_key(""));
  EXPECT_FALSE(sessions.use_key(key.substr(1)));
  EXPECT_TRUE(sessions.use_key(key));
  EXPECT_FALSE(sessions.use_key(key));
  EXPECT_TRUE(sessions.use_key(other));
}

TEST(Cookie, IsForThisServiceAndNoScript) {
  EXPECT_EQ(session_cookie(8080, false, "s"), "affskel-8080=s; Path=/; HttpOnly; SameSite=Strict");
  EXPECT_EQ(session_cookie(8443, true, "s"),
            "__Host-affskel-8443=s; Path=/; HttpOnly; SameSite=Strict; Secure");
  http::Request request;
  request.headers = {{"cookie", "affskel-80=other; x=y;affskel-8080=mine"}};
  EXPECT_EQ(session_secret(request, 8080, false), "mine");
  EXPECT_EQ(session_secret(request, 80, false), "other");
  EXPECT_EQ(session_secret(request, 8080, true), std::nullopt);
  EXPECT_EQ(session_secret(http::Request(), 8080, false), std::nullopt);
}

struct Things {
  Clock::time_point now{};
  Shelf<int> shelf{{2, 4, 100, std::chrono::seconds(60)}, [this] { return now; }};
  std::string put(const std::string& session, int value, std::uint64_t bytes = 1) {
    return shelf.put(session, std::make_shared<int>(value), bytes);
  }
};

TEST(Shelf, GivesThingsToTheirSessionAlone) {
  Things t;
  const std::string key = t.put("ada", 7);
  EXPECT_EQ(*t.shelf.find("ada", key), 7);
  EXPECT_EQ(t.shelf.find("bob", key), nullptr);
  EXPECT_EQ(t.shelf.find("ada", key + "0"), nullptr);
  const auto held = t.shelf.find("ada", key);
  t.shelf.drop_session("ada");
  EXPECT_EQ(t.shelf.find("ada", key), nullptr);
  EXPECT_EQ(*held, 7) << "whoever holds it keeps it";
}

TEST(Shelf, IsBoundedInNumberBytesAndAge) {
  Things t;
  const std::string first = t.put("ada", 1), second = t.put("ada", 2);
  EXPECT_TRUE(t.shelf.find("ada", first));  // used last
  const std::string third = t.put("ada", 3);
  EXPECT_FALSE(t.shelf.find("ada", second));
  EXPECT_TRUE(t.shelf.find("ada", first));
  const std::string large = t.put("bob", 4, 99);
  EXPECT_FALSE(t.shelf.find("ada", third)) << "99 and 1 are 100";
  EXPECT_TRUE(t.shelf.find("ada", first));
  const std::string larger = t.put("cyd", 5, 1000);
  EXPECT_EQ(*t.shelf.find("cyd", larger), 5) << "the newest always has room";
  EXPECT_FALSE(t.shelf.find("bob", large));
  t.now += 61s;
  EXPECT_FALSE(t.shelf.find("cyd", larger));
}

TEST(RequestTarget, IsDecodedOnce) {
  const auto target = http::parse_target("/a%2Fb/%2525?name=x%26y&q=a+b&empty");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/a/b/%25");
  EXPECT_EQ(target->query.at("name"), "x&y");
  EXPECT_EQ(target->query.at("q"), "a b");
  EXPECT_EQ(target->query.at("empty"), "");
  for (const char* malformed :
       {"", "a", "/%", "/%2", "/%0g", "/%+1", "/%-1", "/%00", "/?a=1&a=2", "http://host/"})
    EXPECT_FALSE(http::parse_target(malformed)) << malformed;
}

}  // namespace
}  // namespace affskel::client
