#include "client/connection/session.h"

#include <gtest/gtest.h>

#include <future>
#include <vector>

#include "client/connection/server_choice.h"
#include "client_fixture.h"
#include "test_environment.h"

namespace affskel::client {
namespace {

// The answer comes when the silence was told.
TEST_F(ClientTest, ASilentServerIsToldOnce) {
  std::promise<void> told;
  std::vector<std::string> codes;
  service_.hold = [answer = told.get_future().share()] { answer.wait(); };
  const Environment environment = test_environment({{"HOME", dir_.path()}});
  RetryPolicy policy;
  policy.silence = std::chrono::milliseconds(1);
  Session session(
      choose_server(server_.address(), environment, {}), environment,
      [&](const Notice& notice) {
        codes.push_back(notice.code);
        told.set_value();
      },
      policy);
  EXPECT_EQ(session.get_job(service_.job.id()).id(), service_.job.id());
  EXPECT_EQ(session.get_job(service_.job.id()).id(), service_.job.id());
  EXPECT_EQ(codes, std::vector<std::string>{"NO_ANSWER_YET"});
}

}  // namespace
}  // namespace affskel::client
