#include "loop/lease_loop.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "link_fixture.h"
#include "tools/crossing_boxes.h"

namespace affskel::worker {
namespace {

class LoopTest : public LinkTest {
 protected:
  void SetUp() override {
    server_.set_input(v1::ARTIFACT_KIND_MESH, sample_mesh());
    server_.set_input(v1::ARTIFACT_KIND_FIELD, empty_field(prepared_));
  }

  // Runs the loop until the fake server has nothing more to offer.
  int run(std::uint64_t max_jobs = 0) {
    LeaseLoopOptions options;
    options.server = server_.address();
    options.max_jobs = max_jobs;
    options.patience = std::chrono::seconds(5);
    options.prepare_limit = prepare_limit_;
    int code = -1;
    std::thread loop([&] { code = static_cast<int>(run_lease_loop(options, stop_.get_token())); });
    server_.wait_for_idle();
    stop_.request_stop();
    loop.join();
    return code;
  }

  void offer(const v1::Lease& lease) { server_.offer(lease); }

  // A task that is fetching its input, and renews its lease after one millisecond.
  static v1::Lease restless_lease(const std::string& token, v1::TaskKind kind = v1::TASK_KIND_PREPARE) {
    v1::Lease lease = other_lease(token, kind);
    lease.set_lease_ms(4);
    return lease;
  }

  std::chrono::seconds prepare_limit_{3600};
};

TEST_F(LoopTest, PreparesErodesAndDerives) {
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  offer(erode_lease(prepared_, "b", 0, 256));
  EXPECT_EQ(run(), 0);
  ASSERT_EQ(server_.completions().size(), 1U);
  const FakeServer::Completion prepare = server_.completions()[0];
  EXPECT_EQ(prepare.header.prepared().SerializeAsString(), prepared_.summary().SerializeAsString());
  EXPECT_EQ(prepare.data.substr(0, prepare.header.lattice_bytes()),
            prepared_.lattice_message().SerializeAsString());
  EXPECT_EQ(server_.calls("FetchInput1"), 1) << "the prepared mesh is kept for the next task";
  EXPECT_EQ(server_.lease_requests()[1].preferred_job(), other_lease("", v1::TASK_KIND_PREPARE).job().id());
  EXPECT_TRUE(merged(prepared_, server_.reports()) == finished_field(prepared_));
}

// Until a task comes that looks at something else.
TEST_F(LoopTest, TellsWhatItHasDerivedOf) {
  server_.set_input(v1::ARTIFACT_KIND_FIELD, finished_field(prepared_));
  v1::Lease sheet = derive_lease(prepared_, "a", v1::TASK_KIND_SURFACE);
  sheet.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  offer(sheet);
  sheet.set_token("b");
  offer(sheet);
  v1::Lease chords = derive_lease(prepared_, "c", v1::TASK_KIND_SURFACE);  // which look at no ridge
  chords.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  offer(chords);
  EXPECT_EQ(run(), 0);
  std::vector<bool> derived;
  for (const v1::LeaseTaskRequest& request : server_.lease_requests()) derived.push_back(request.derived());
  EXPECT_EQ(derived.front(), false);
  EXPECT_EQ(std::count(derived.begin(), derived.end(), true), 2);
  EXPECT_EQ(derived.back(), false);
  ASSERT_EQ(server_.completions().size(), 3U);
  EXPECT_EQ(server_.completions()[0].data, server_.completions()[1].data);
}

// What a fenced report held is known to no server: the next task of the job must start afresh, else those
// points would never be reported again.
TEST_F(LoopTest, ForgetsTheFieldWhenALeaseIsLost) {
  server_.fail_next("ReportErosion", {grpc::StatusCode::ABORTED, "fenced"});
  offer(erode_lease(prepared_, "a", 0, 256));
  offer(erode_lease(prepared_, "b", 0, 256));
  offer(erode_lease(prepared_, "c", 0, 256));
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(server_.calls("FetchInput4"), 2);
  EXPECT_EQ(server_.calls("ReturnLease"), 1) << "the second was begun before the loss of the first was known";
  EXPECT_TRUE(merged(prepared_, server_.reports()) == finished_field(prepared_));
}

TEST_F(LoopTest, ErodesBlockAfterBlock) {
  std::uint64_t begin = 0;
  for (std::uint64_t end : {100U, 101U, 200U, 230U, 256U}) {
    offer(erode_lease(prepared_, "block" + std::to_string(end), begin, end));
    begin = end;
  }
  EXPECT_EQ(run(), 0);
  const std::vector<FakeServer::Report> reports = server_.reports();
  EXPECT_EQ(positions(reports).size(), 256U);
  EXPECT_EQ(std::count_if(reports.begin(), reports.end(),
                          [](const FakeServer::Report& r) { return r.header.block_done(); }),
            5);
  EXPECT_TRUE(merged(prepared_, reports) == finished_field(prepared_));
  EXPECT_EQ(server_.calls("FetchInput4"), 1);
  EXPECT_EQ(server_.calls("ReturnLease"), 0);
}

TEST_F(LoopTest, FetchesNoFieldOfWhichNothingIsKnown) {
  v1::Lease lease = erode_lease(prepared_, "a", 0, 256);
  lease.mutable_job()->set_directions_done(0);
  offer(lease);
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(server_.calls("FetchInput4"), 0);
  EXPECT_TRUE(merged(prepared_, server_.reports()) == finished_field(prepared_));
}

// The server was started anew: what the field knows may be news to it.
TEST_F(LoopTest, FetchesAFieldOfAnotherNameAnewAndKeepsTheMesh) {
  for (const char* name : {"before", "after"}) {
    v1::Lease lease = erode_lease(prepared_, name, 0, 256);
    lease.set_field(name);
    offer(lease);
  }
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(server_.calls("FetchInput4"), 2);
  EXPECT_EQ(server_.calls("FetchInput1"), 1);
}

TEST_F(LoopTest, NamesTheLeasesThatItHoldsWhenItAsksForMore) {
  const std::vector<std::string> tokens = {"a", "b", "c"};
  for (std::size_t i = 0; i < tokens.size(); ++i)
    offer(erode_lease(prepared_, tokens[i], 80 * i, 80 * i + 80));
  EXPECT_EQ(run(), 0);
  const std::vector<v1::LeaseTaskRequest> requests = server_.lease_requests();
  ASSERT_GT(requests.size(), tokens.size());
  EXPECT_EQ(requests[0].held_size(), 0);
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const auto& held = requests[i + 1].held();
    EXPECT_NE(std::find(held.begin(), held.end(), tokens[i]), held.end())
        << "its report may not be acknowledged: " << tokens[i];
  }
}

// The report that fails is the first block's, on its way while the second is computed.
TEST_F(LoopTest, AFailedLastReportFailsItsOwnTask) {
  server_.fail_next("ReportErosion", {grpc::StatusCode::INVALID_ARGUMENT, "the numbers do not add up"});
  v1::Lease first = erode_lease(prepared_, "a", 0, 128), second = erode_lease(prepared_, "b", 128, 256);
  for (v1::Lease* lease : {&first, &second}) {
    lease->set_report_interval_ms(60000);  // no reports but the last
    offer(*lease);
  }
  EXPECT_EQ(run(), 0);
  ASSERT_EQ(server_.failures().size(), 1U);
  EXPECT_EQ(server_.failures()[0].token(), "a");
  EXPECT_TRUE(server_.failures()[0].retryable());
  EXPECT_NE(server_.failures()[0].error().message().find("do not add up"), std::string::npos);
  EXPECT_EQ(server_.calls("ReturnLease"), 1) << "what the second computed may depend on the first";
}

TEST_F(LoopTest, AFailedLastReportIsSaidBeforeItWaitsForWork) {
  server_.fail_next("ReportErosion", {grpc::StatusCode::INVALID_ARGUMENT, "the numbers do not add up"});
  offer(erode_lease(prepared_, "a", 0, 256));
  EXPECT_EQ(run(), 0);
  ASSERT_EQ(server_.failures().size(), 1U);
  for (const v1::LeaseTaskRequest& request : server_.lease_requests())
    EXPECT_TRUE(request.wait_ms() == 0 || request.held_size() == 0) << "its report had not been heard of";
}

TEST_F(LoopTest, DerivesSkeletonAndSurface) {
  const std::string field = finished_field(prepared_);
  server_.set_input(v1::ARTIFACT_KIND_FIELD, field);
  offer(derive_lease(prepared_, "a", v1::TASK_KIND_SKELETON));
  offer(derive_lease(prepared_, "b", v1::TASK_KIND_SURFACE));
  EXPECT_EQ(run(), 0);
  const auto completions = server_.completions();
  ASSERT_EQ(completions.size(), 2U);
  v1::SkeletonPoints skeleton;
  ASSERT_TRUE(skeleton.ParseFromString(completions[0].data));
  EXPECT_EQ(completions[0].header.points(), static_cast<std::uint64_t>(skeleton.point_size()));
  ASSERT_GT(skeleton.point_size(), 20);
  for (int i = 0; i < skeleton.point_size(); ++i) {
    EXPECT_GT(std::abs(skeleton.divergence(i)), 7);
    EXPECT_LT(std::abs(skeleton.xyz(3 * i + 2)), 600) << "near the torus's plane";
  }
  v1::TriangleMesh surface;
  ASSERT_TRUE(surface.ParseFromString(completions[1].data));
  EXPECT_GT(surface.corners_size(), 0);
}

// Points and directions are named by number: the wrong lattice would give a skeleton in the wrong places.
TEST_F(LoopTest, RefusesToDeriveFromAnotherLattice) {
  server_.set_input(v1::ARTIFACT_KIND_FIELD, finished_field(prepared_));
  v1::Lease lease = derive_lease(prepared_, "a", v1::TASK_KIND_SKELETON);
  lease.mutable_job()->mutable_prepared()->set_spacing(std::nextafter(prepared_.lattice().spacing, 0.0));
  offer(lease);
  lease = derive_lease(prepared_, "b", v1::TASK_KIND_SKELETON);
  lease.mutable_job()->mutable_prepared()->set_frame(1, 1e-3);
  offer(lease);
  lease = derive_lease(prepared_, "c", v1::TASK_KIND_SKELETON);
  lease.mutable_job()->mutable_prepared()->clear_frame();  // of a job before there were frames
  offer(lease);
  EXPECT_EQ(run(), 0);
  ASSERT_EQ(server_.failures().size(), 2U);
  EXPECT_EQ(server_.failures()[0].error().code(), "INTERNAL");
  EXPECT_EQ(server_.completions().size(), 1U);
}

// As a host would whose search for the spacing of so many points ends one rounding away.
TEST_F(LoopTest, LaysTheLatticeOfThePreparedSpacing) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_target_points(2000);
  const PreparedJob searched(sample_mesh(), params);
  const double elsewhere = std::nextafter(searched.lattice().spacing, 0.0);
  server_.set_input(v1::ARTIFACT_KIND_FIELD, finished_field(searched));
  v1::Lease lease = derive_lease(searched, "a", v1::TASK_KIND_SKELETON);
  *lease.mutable_job()->mutable_params() = params;
  lease.mutable_job()->mutable_prepared()->set_spacing(elsewhere);
  offer(lease);
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(server_.failures().size(), 0U);
  EXPECT_EQ(server_.completions().size(), 1U);
}

TEST_F(LoopTest, FailsATaskForGoodOnABadMeshAndParameter) {
  server_.set_input(v1::ARTIFACT_KIND_MESH, "OFF\n1 0 0\n0 0\n");
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  EXPECT_EQ(run(), 0);
  ASSERT_EQ(server_.failures().size(), 1U);
  EXPECT_FALSE(server_.failures()[0].retryable());
  EXPECT_EQ(server_.failures()[0].error().code(), "BAD_INPUT");
  EXPECT_EQ(server_.failures()[0].error().line(), 3U);
}

// As when the server has no more files to open for a while.
TEST_F(LoopTest, PassingTroubleOfTheServerCostsNoAttempt) {
  server_.fail_next("FetchInput1", {grpc::StatusCode::INTERNAL, "unable to open database file"}, 3);
  server_.fail_next("FetchInput1", {grpc::StatusCode::RESOURCE_EXHAUSTED, "full"}, 2);
  server_.fail_next("CompleteTask", {grpc::StatusCode::UNKNOWN, "trouble"}, 1);
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  EXPECT_EQ(run(), 0);
  EXPECT_TRUE(server_.failures().empty());
  EXPECT_EQ(server_.completions().size(), 1U);
  EXPECT_EQ(server_.calls("FetchInput1"), 6);
}

TEST_F(LoopTest, DropsACancelledTaskWithoutWaitingForItsEnd) {
  server_.hold_next_fetch();
  server_.cancel_next_renewal();
  offer(restless_lease("a"));
  v1::Lease next = other_lease("b", v1::TASK_KIND_PREPARE);
  next.mutable_job()->set_id("ffff");
  offer(next);
  const LogCapture log;
  EXPECT_EQ(run(), 0);
  ASSERT_EQ(server_.completions().size(), 1U);
  EXPECT_EQ(server_.completions()[0].header.token(), "b");
  EXPECT_TRUE(server_.failures().empty());
  EXPECT_EQ(server_.calls("ReturnLease"), 0) << "the server has taken it already";
  EXPECT_NE(log.text().find("cancelled"), std::string::npos) << log.text();
  EXPECT_EQ(log.text().find("lost"), std::string::npos) << log.text();
}

TEST_F(LoopTest, DropsATaskWhoseLeaseIsLost) {
  server_.hold_next_fetch();
  server_.fail_next("RenewLease", {grpc::StatusCode::ABORTED, "fenced"});
  offer(restless_lease("a", v1::TASK_KIND_SKELETON));
  const LogCapture log;
  EXPECT_EQ(run(), 0);
  EXPECT_TRUE(server_.completions().empty());
  EXPECT_TRUE(server_.failures().empty());
  EXPECT_NE(log.text().find("event=lease_lost "), std::string::npos) << log.text();
}

TEST_F(LoopTest, GivesAPreparationBackWhenItIsToStop) {
  server_.hold_next_fetch();
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  LeaseLoopOptions options;
  options.server = server_.address();
  int code = -1;
  std::thread loop([&] { code = static_cast<int>(run_lease_loop(options, stop_.get_token())); });
  server_.wait_for_call("FetchInput1");
  stop_.request_stop();
  loop.join();
  EXPECT_EQ(code, 0);
  EXPECT_EQ(server_.calls("ReturnLease"), 1);
  EXPECT_TRUE(server_.failures().empty());
}

TEST_F(LoopTest, HearsOfACancelledTaskWhileItMakesTheMeshReady) {
  server_.set_input(v1::ARTIFACT_KIND_MESH, tests::crossing_boxes(20000));
  server_.cancel_next_renewal();
  v1::Lease lease = other_lease("a", v1::TASK_KIND_PREPARE);
  lease.set_lease_ms(2000);
  lease.set_report_interval_ms(500);
  offer(lease);
  EXPECT_EQ(run(), 0);
  EXPECT_TRUE(server_.completions().empty());
  EXPECT_TRUE(server_.failures().empty());
  EXPECT_EQ(server_.calls("RenewLease"), 1);
}

TEST_F(LoopTest, FailsATaskForGoodWhenTheMeshTakesTooLong) {
  server_.set_input(v1::ARTIFACT_KIND_MESH, tests::crossing_boxes(20000));
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  prepare_limit_ = std::chrono::seconds(1);
  EXPECT_EQ(run(), 0);
  EXPECT_TRUE(server_.completions().empty());
  ASSERT_EQ(server_.failures().size(), 1U);
  EXPECT_FALSE(server_.failures()[0].retryable());
  EXPECT_EQ(server_.failures()[0].error().code(), "LIMIT");
  EXPECT_NE(server_.failures()[0].error().message().find("1 s of processor time"), std::string::npos)
      << server_.failures()[0].error().message();
}

TEST_F(LoopTest, GivesALeaseBackBeyondMaxJobs) {
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  v1::Lease second = other_lease("b", v1::TASK_KIND_PREPARE);
  second.mutable_job()->set_id("ffff");
  server_.offer(second);
  LeaseLoopOptions options;
  options.server = server_.address();
  options.max_jobs = 1;
  EXPECT_EQ(run_lease_loop(options, stop_.get_token()), base::ExitCode::kDone);
  EXPECT_EQ(server_.calls("ReturnLease"), 1);
  EXPECT_EQ(server_.completions().size(), 1U);
}

// A call that outlasted the time would hold a batch system's node for nothing.
TEST_F(LoopTest, WaitsNoLongerForWorkThanUntilItLeaves) {
  LeaseLoopOptions options;
  options.server = server_.address();
  options.idle_exit = std::chrono::seconds(1);
  EXPECT_EQ(run_lease_loop(options, {}), base::ExitCode::kDone);
  const std::vector<v1::LeaseTaskRequest> asked = server_.lease_requests();
  EXPECT_TRUE(std::is_sorted(asked.rbegin(), asked.rend(),
                             [](const auto& a, const auto& b) { return a.wait_ms() < b.wait_ms(); }));
  EXPECT_LE(asked.front().wait_ms(), 1000U);
  EXPECT_GE(asked.back().wait_ms(), 1U) << "without a wait it would ask again and again";
}

TEST_F(LoopTest, AsksSeldomWhileThereIsNoWork) {
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(server_.lease_requests().front().wait_ms(), 10000U);
}

TEST(LeaseLoop, LeavesWhenTheServerStaysAway) {
  LeaseLoopOptions options;
  options.server = "unix:/nonexistent/affskel.sock";
  options.patience = std::chrono::seconds(0);
  EXPECT_EQ(run_lease_loop(options, {}), base::ExitCode::kUnreachable);
}

}  // namespace
}  // namespace affskel::worker
