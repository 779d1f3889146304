#include "server_link.h"

#include "link_fixture.h"

namespace affskel::worker {
namespace {

TEST_F(LinkTest, TriesAgainWhileTheServerIsAway) {
  server_.fail_next("RenewLease", {grpc::StatusCode::UNAVAILABLE, "away"}, 3);
  server_.fail_next("RenewLease", {grpc::StatusCode::RESOURCE_EXHAUSTED, "disk full"}, 1);
  link().renew("t");
  EXPECT_EQ(server_.calls("RenewLease"), 5);
}

TEST_F(LinkTest, GivesUpWhenTheLeaseIsLostOrTheServerStaysAway) {
  server_.fail_next("RenewLease", {grpc::StatusCode::ABORTED, "fenced"});
  EXPECT_THROW(link().renew("t"), LeaseLost);
  server_.fail_next("RenewLease", {grpc::StatusCode::UNAVAILABLE, "away"}, 100);
  EXPECT_THROW(link(std::chrono::seconds(0)).renew("t"), ServerGone);
}

TEST_F(LinkTest, FetchesAgainWhatArrivedDamaged) {
  const std::string mesh = sample_mesh();
  server_.set_input(v1::ARTIFACT_KIND_MESH, mesh);
  server_.damage_next_fetch();
  EXPECT_TRUE(link().fetch("t", v1::ARTIFACT_KIND_MESH) == mesh);
  EXPECT_EQ(server_.calls("FetchInput1"), 2);
}

}  // namespace
}  // namespace affskel::worker
