#include "calls/upload.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "calls/status.h"

namespace affskel::server {
namespace {

grpc::StatusCode add(Upload& upload, std::size_t bytes) {
  return guarded([&] { upload.add(std::string(bytes, 'm')); }).error_code();
}

TEST(UploadTest, AllTogetherStayBelowTheBudget) {
  UploadBudget budget(100);
  Upload first(budget, 1000);
  EXPECT_EQ(add(first, 30), grpc::StatusCode::OK);
  EXPECT_EQ(add(first, 30), grpc::StatusCode::OK);
  {
    Upload second(budget, 1000);
    EXPECT_EQ(add(second, 1), grpc::StatusCode::OK);
    EXPECT_EQ(add(second, 39), grpc::StatusCode::OK);
    EXPECT_EQ(add(second, 20), grpc::StatusCode::UNAVAILABLE);
    EXPECT_EQ(add(first, 1), grpc::StatusCode::UNAVAILABLE) << "the second holds what it took so far";
  }
  Upload third(budget, 1000);
  EXPECT_EQ(add(third, 40), grpc::StatusCode::OK) << "an upload that ended gives back what it took";
  EXPECT_EQ(add(third, 1), grpc::StatusCode::UNAVAILABLE);
}

TEST(UploadTest, LeavesAPartOfTheBudgetToOthers) {
  UploadBudget budget(100);
  Upload client(budget, 1000, 25), worker(budget, 1000);
  EXPECT_EQ(add(client, 75), grpc::StatusCode::OK);
  EXPECT_EQ(add(client, 1), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(add(worker, 25), grpc::StatusCode::OK);
}

TEST(UploadTest, HoldsWhatHasComeAndNotWhatIsAnnounced) {
  UploadBudget budget(std::uint64_t{1} << 40);
  Upload upload(budget, std::uint64_t{1} << 39);
  EXPECT_EQ(add(upload, 1000), grpc::StatusCode::OK);
  EXPECT_LE(upload.data().capacity(), 5000U);
  EXPECT_EQ(add(upload, 99000), grpc::StatusCode::OK);
  EXPECT_LE(upload.data().capacity(), 500000U);
}

TEST(UploadTest, MoreThanAnnouncedIsRefused) {
  UploadBudget budget(100);
  Upload upload(budget, 10);
  EXPECT_EQ(add(upload, 10), grpc::StatusCode::OK);
  EXPECT_EQ(add(upload, 1), grpc::StatusCode::INVALID_ARGUMENT);
}

}  // namespace
}  // namespace affskel::server
