#include "wire/grpc_log.h"

#include <grpc/support/log.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::wire {
namespace {

std::vector<std::string>& entries() {
  static std::vector<std::string> all;
  return all;
}

// A message whose name is no UTF-8 is refused, and what a peer sends fills no log.
TEST(GrpcLog, HasWhatGrpcSaysAndNothingOfBytesThatAPeerSent) {
  entries().clear();
  const GrpcLog log([](bool, const std::string& entry) { entries().push_back(entry); });
  testing::internal::CaptureStderr();
  v1::Job job;
  EXPECT_FALSE(job.ParseFromString("\x12\x01\xff"));
  gpr_log(GPR_ERROR, "that's it");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(entries().size(), 1U);
  EXPECT_NE(entries()[0].find("that's it"), std::string::npos) << entries()[0];
}

}  // namespace
}  // namespace affskel::wire
