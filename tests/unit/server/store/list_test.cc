#include <gtest/gtest.h>

#include <set>

#include "service_fixture.h"

namespace affskel::server {
namespace {

class ListTest : public ServiceTest {
 protected:
  grpc::Status list(std::uint32_t limit, const std::string& token, v1::ListJobsResponse& response) {
    grpc::ClientContext context;
    v1::ListJobsRequest request;
    request.set_limit(limit);
    request.set_page_token(token);
    return client_->ListJobs(&context, request, &response);
  }
};

TEST_F(ListTest, PagesHoldEveryJobOnce) {
  std::set<std::string> submitted, listed;
  for (int i = 0; i < 10; ++i) submitted.insert(submit("OFF " + std::to_string(i)));
  std::string token;
  int pages = 0;
  do {
    v1::ListJobsResponse response;
    ASSERT_TRUE(list(3, token, response).ok());
    for (const v1::Job& job : response.jobs()) EXPECT_TRUE(listed.insert(job.id()).second);
    token = response.next_page_token();
    ++pages;
  } while (!token.empty());
  EXPECT_EQ(pages, 4);
  EXPECT_EQ(listed, submitted);
}

TEST_F(ListTest, ReferencesAreQuotedAsTheyWereGiven) {
  grpc::ClientContext context;
  v1::GetJobRequest request;
  request.set_job("@LAST");
  v1::Job job;
  const grpc::Status status = client_->GetJob(&context, request, &job);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_NE(status.error_message().find("'@LAST'"), std::string::npos) << status.error_message();
}

TEST_F(ListTest, AJobKeepsHowItsSolidStands) {
  const std::string id = submit("OFF 1"), other = submit("OFF 2");
  const auto set = [&](int up, int front) {
    grpc::ClientContext context;
    v1::SetStanceRequest request;
    request.set_job(id);
    request.mutable_stance()->set_up(static_cast<v1::AxisDirection>(up));
    request.mutable_stance()->set_front(static_cast<v1::AxisDirection>(front));
    v1::Job job;
    return client_->SetStance(&context, request, &job).error_code();
  };
  EXPECT_FALSE(job(id).has_stance());
  EXPECT_EQ(set(v1::AXIS_DIRECTION_MINUS_Z, v1::AXIS_DIRECTION_X), grpc::StatusCode::OK);
  EXPECT_EQ(job(id).stance().up(), v1::AXIS_DIRECTION_MINUS_Z);
  EXPECT_EQ(job(id).stance().front(), v1::AXIS_DIRECTION_X);
  EXPECT_FALSE(job(other).has_stance());
  for (const auto& [up, front] : {std::pair{5, 6}, {1, 1}, {1, 0}, {0, 3}, {7, 1}, {1, -1}})
    EXPECT_EQ(set(up, front), grpc::StatusCode::INVALID_ARGUMENT) << up << " " << front;
  EXPECT_EQ(job(id).stance().up(), v1::AXIS_DIRECTION_MINUS_Z) << "a refusal changes nothing";
  EXPECT_EQ(set(0, 0), grpc::StatusCode::OK);
  EXPECT_FALSE(job(id).has_stance());
}

TEST_F(ListTest, RefusesWhatIsNoToken) {
  submit("OFF 1");
  submit("OFF 2");
  v1::ListJobsResponse response;
  ASSERT_TRUE(list(1, "", response).ok());
  const std::string token = response.next_page_token();
  ASSERT_FALSE(token.empty());
  for (const std::string& bad :
       {std::string("2"), std::string("before-"), std::string("before-0"), std::string("before--1"),
        std::string("before-99999999999999999999"), token + " ", token + std::string(1, '\0'), "0" + token}) {
    const grpc::Status status = list(1, bad, response);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << bad;
    EXPECT_NE(status.error_message().find("page_token"), std::string::npos) << status.error_message();
  }
  const grpc::Status status = list(1001, "", response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_NE(status.error_message().find("1001"), std::string::npos) << status.error_message();
}

}  // namespace
}  // namespace affskel::server
