#include <gtest/gtest.h>

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <thread>

#include "core/error.h"
#include "derive/derive.h"
#include "erode_task.h"
#include "fake_server.h"
#include "lease_loop.h"
#include "sample_job.h"
#include "server_link.h"
#include "wire/erosion_bound.h"

namespace affskel::worker {
namespace {

TEST(PreparedJob, DescribesWhatItPrepared) {
  const PreparedJob job(sample_mesh(), sample_params());
  const v1::PreparedSummary summary = job.summary();
  EXPECT_EQ(summary.triangles(), 256U);
  EXPECT_EQ(summary.genus(), 1);
  EXPECT_EQ(summary.directions(), 256U);
  EXPECT_EQ(summary.points(), job.lattice().points);
  EXPECT_EQ(job.directions_message().xyz_size(), 3 * 256);
  const v1::Lattice lattice = job.lattice_message();
  std::uint64_t points = 0, end = 0;
  for (int r = 0; r < lattice.run_start_size(); ++r) {
    EXPECT_GE(lattice.run_start(r), end);
    end = lattice.run_start(r) + lattice.run_length(r);
    points += lattice.run_length(r);
    EXPECT_EQ(lattice.run_start(r) / lattice.dims(2), (end - 1) / lattice.dims(2)) << "a run leaves its line";
  }
  EXPECT_EQ(points, summary.points());
}

TEST(PreparedJob, LaysTheLatticeInTheFrameThatIsAskedFor) {
  v1::ErosionParams params = sample_params();
  const v1::PreparedSummary plain = PreparedJob(sample_mesh(), params).summary();
  ASSERT_EQ(plain.frame_size(), 9);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(plain.frame(i), i % 4 == 0 ? 1 : 0);
  params.set_frame(v1::FRAME_AFFINE);
  params.set_directions("triangles+sphere:20");
  const PreparedJob affine(sample_mesh(), params);
  const v1::PreparedSummary summary = affine.summary();
  const v1::Lattice lattice = affine.lattice_message();
  // A torus about z is wide and flat.
  for (int axis = 0; axis < 3; ++axis) {
    const double x = summary.frame(3 * axis), y = summary.frame(3 * axis + 1),
                 z = summary.frame(3 * axis + 2);
    if (std::abs(z) > 0.1) {
      EXPECT_LT(std::abs(z), 0.9);
    } else {
      EXPECT_GT(std::hypot(x, y), 1.1);
    }
  }
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(lattice.axes(i), 500 * summary.frame(i), 1e-9);
  EXPECT_EQ(summary.spacing(), 500);
  // The sphere's directions crowd round the axis that the frame has shortened.
  double along_x = 0, along_z = 0;
  for (std::size_t i = 256; i < affine.directions().size(); ++i) {
    along_x += std::abs(affine.directions()[i].x);
    along_z += std::abs(affine.directions()[i].z);
  }
  EXPECT_GT(along_z, 1.2 * along_x);
  params.set_frame(static_cast<v1::Frame>(99));
  EXPECT_THROW(PreparedJob(sample_mesh(), params), core::CoreError);
}

int count_changes(core::ErosionField& field) {
  int count = 0;
  field.take_changes([&](std::uint32_t, const core::FieldValue&) { ++count; });
  return count;
}

TEST(PreparedJob, StartsFromTheStoredField) {
  PreparedJob job(sample_mesh(), sample_params());
  const std::string stored = finished_field(job);
  core::Erosion& erosion = job.erosion(1, stored);
  EXPECT_EQ(count_changes(erosion.field()), 0);
  // Doing a direction again improves nothing.
  const std::uint32_t direction = 17;
  core::ExecutionContext context;
  erosion.run({&direction, 1}, context);
  EXPECT_EQ(count_changes(erosion.field()), 0);
  EXPECT_THROW(unpack_field(stored.substr(1), job.lattice().points), core::CoreError);
}

/// Sets the proxy of the environment, and no exceptions from it, while it lives.
class ProxyEnvironment {
 public:
  explicit ProxyEnvironment(const char* proxy) {
    for (const char* name : {"http_proxy", "grpc_proxy", "https_proxy", "no_proxy", "no_grpc_proxy"}) {
      const char* value = std::getenv(name);
      before_.emplace_back(name, value == nullptr ? std::nullopt : std::optional<std::string>(value));
      unsetenv(name);
    }
    setenv("http_proxy", proxy, 1);
  }
  ProxyEnvironment(const ProxyEnvironment&) = delete;
  ProxyEnvironment& operator=(const ProxyEnvironment&) = delete;
  ~ProxyEnvironment() {
    for (const auto& [name, value] : before_) {
      value ? setenv(name, value->c_str(), 1) : unsetenv(name);
    }
  }

 private:
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

class LinkTest : public testing::Test {
 protected:
  ServerLink link(std::chrono::seconds patience = std::chrono::seconds(20)) {
    return ServerLink({server_.address(), patience}, stop_.get_token());
  }

  FakeServer server_;
  std::stop_source stop_;
  PreparedJob prepared_{sample_mesh(), sample_params()};
  LastReport last_{[](const std::string&, const std::exception_ptr&) { ADD_FAILURE() << "a report failed"; }};
};

TEST_F(LinkTest, TriesAgainWhileTheServerIsAway) {
  server_.fail_next("RenewLease", {grpc::StatusCode::UNAVAILABLE, "away"}, 3);
  server_.fail_next("RenewLease", {grpc::StatusCode::RESOURCE_EXHAUSTED, "disk full"}, 1);
  link().renew("t");
  EXPECT_EQ(server_.calls("RenewLease"), 5);
}

TEST_F(LinkTest, ReachesAServerOfThisMachineWithoutTheProxyOfTheEnvironment) {
  const ProxyEnvironment nobody_there("http://127.0.0.1:9");
  ServerLink({server_.tcp_address(), std::chrono::seconds(1)}, stop_.get_token()).renew("t");
  EXPECT_EQ(server_.calls("RenewLease"), 1);
}

TEST_F(LinkTest, SaysOnceThatTheServerIsAway) {
  std::ostringstream lines;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(lines)));
  server_.fail_next("RenewLease", {grpc::StatusCode::UNAVAILABLE, "away"}, 3);
  ServerLink to_server = link();
  to_server.renew("t");
  to_server.renew("t");
  spdlog::set_default_logger(before);
  const std::string log = lines.str();
  const std::size_t first = log.find("does not answer");
  EXPECT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find("does not answer", first + 1), std::string::npos) << log;
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

// Merges reports as the server does, into the field's bytes.
std::string merged(const PreparedJob& prepared, const std::vector<FakeServer::Report>& reports) {
  std::vector<core::FieldValue> field(prepared.lattice().points);
  for (const FakeServer::Report& report : reports) {
    EXPECT_EQ(report.header.records(), static_cast<std::uint64_t>(report.records.point_size()));
    for (int i = 0; i < report.records.point_size(); ++i) {
      const core::FieldValue offered{report.records.erosion(i), report.records.area(i),
                                     report.records.direction(i)};
      core::FieldValue& kept = field[report.records.point(i)];
      if (offered.improves(kept)) kept = offered;
    }
  }
  std::string bytes;
  for (const core::FieldValue& value : field) {
    bytes.append(reinterpret_cast<const char*>(&value.erosion), 8);
    bytes.append(reinterpret_cast<const char*>(&value.area), 8);
    bytes.append(reinterpret_cast<const char*>(&value.direction), 4);
  }
  return bytes;
}

std::vector<std::uint64_t> positions(const std::vector<FakeServer::Report>& reports) {
  std::vector<std::uint64_t> all;
  for (const FakeServer::Report& report : reports) {
    for (const v1::PositionRange& range : report.header.positions_done()) {
      for (std::uint64_t p = range.begin(); p < range.end(); ++p) all.push_back(p);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST_F(LinkTest, ErodeReportsEveryPositionOnceAndAllItsPoints) {
  ServerLink to_server = link();
  core::Erosion& erosion = prepared_.erosion(2, empty_field(prepared_));
  v1::Lease lease = erode_lease(prepared_, "t", 0, 100);
  lease.mutable_positions(0)->set_end(60);
  v1::PositionRange* rest = lease.add_positions();
  rest->set_begin(60);
  rest->set_end(256);
  server_.fail_next("ReportErosion", {grpc::StatusCode::UNAVAILABLE, "away"}, 2);
  int nearly_done = 0;
  EXPECT_EQ(erode(lease, prepared_, erosion, to_server, stop_.get_token(), last_, [&] { ++nearly_done; }),
            ErodeEnd::kBlockDone);
  EXPECT_LE(nearly_done, 1);
  last_.wait();
  const std::vector<FakeServer::Report> reports = server_.reports();
  EXPECT_TRUE(reports.back().header.block_done());
  const std::vector<std::uint64_t> done = positions(reports);
  ASSERT_EQ(done.size(), 256U);
  for (std::uint64_t p = 0; p < 256; ++p) EXPECT_EQ(done[p], p);
  EXPECT_TRUE(merged(prepared_, reports) == finished_field(prepared_));
}

// One worker does the last directions and is told, after its first report, what another found in all before:
// together they must have reported the whole field, and the one nothing that the other has outdone.  (Half
// and half would not do: the torus is its own mirror image, and both halves give much the same.)
TEST_F(LinkTest, ErodeReportsNothingThatAnotherWorkerHasOutdone) {
  const auto part = [&](std::uint64_t begin, std::uint64_t end) {
    PreparedJob job(sample_mesh(), sample_params());
    core::Erosion& erosion = job.erosion(1, empty_field(job));
    ServerLink to_server({server_.address(), std::chrono::seconds(20), "me"}, stop_.get_token());
    const std::size_t before = server_.reports().size();
    // Two blocks: what is learnt from the first one's report counts in the second.
    for (const auto& [from, to] : {std::pair{begin, begin + 1}, std::pair{begin + 1, end}}) {
      v1::Lease lease = erode_lease(job, "t", from, to);
      lease.set_report_interval_ms(60000);
      EXPECT_EQ(erode(lease, job, erosion, to_server, stop_.get_token(), last_, [] {}), ErodeEnd::kBlockDone);
      last_.wait();
    }
    const std::vector<FakeServer::Report> reports = server_.reports();
    EXPECT_EQ(reports.back().header.bounds_for(), "me");
    return std::vector<FakeServer::Report>(reports.begin() + static_cast<std::ptrdiff_t>(before),
                                           reports.end());
  };
  const std::vector<FakeServer::Report> first = part(0, 224), alone = part(224, 256);
  const std::vector<core::FieldValue> known =
      unpack_field(merged(prepared_, first), prepared_.lattice().points);
  // Of the last report: how many records are worse than what is known, by more than rounding.
  const auto outdone = [&](const std::vector<FakeServer::Report>& reports) {
    const v1::FieldRecords& records = reports.back().records;
    int count = 0;
    for (int i = 0; i < records.point_size(); ++i) {
      count += records.erosion(i) > (1 + 1e-5) * known[records.point(i)].erosion ? 1 : 0;
    }
    return count;
  };
  server_.on_report([&](const v1::ReportErosionHeader&) {
    v1::ReportResponse response;
    v1::ErosionBounds* bounds = response.add_bounds();
    for (std::uint32_t p = 0; p < known.size(); ++p) {
      bounds->add_step(p == 0 ? 0 : 1);
      bounds->add_bound(wire::bound_above(known[p].erosion));
    }
    bounds->add_step(0xFFFFFFFFU);  // beyond the field
    bounds->add_bound(0);
    return response;
  });
  const std::vector<FakeServer::Report> second = part(224, 256);
  EXPECT_GT(outdone(alone), 100);
  EXPECT_EQ(outdone(second), 0);
  std::vector<FakeServer::Report> together = first;
  together.insert(together.end(), second.begin(), second.end());
  EXPECT_TRUE(merged(prepared_, together) == finished_field(prepared_));
}

// The next block goes on while the report of the one before is on its way, but reports nothing of its own
// until that is acknowledged: when it is not, points that both improved would be missing.
TEST_F(LinkTest, ErodeReportsNothingAfterALostBlock) {
  ServerLink to_server = link();
  core::Erosion& erosion = prepared_.erosion(1, empty_field(prepared_));
  last_.start("before", [] { throw LeaseLost("fenced"); });
  EXPECT_THROW(erode(erode_lease(prepared_, "t", 0, 256), prepared_, erosion, to_server, stop_.get_token(),
                     last_, [] {}),
               LeaseLost);
  EXPECT_EQ(server_.calls("ReportErosion"), 0);
}

TEST_F(LinkTest, ErodeStopsWithEverythingReportedThatIsDone) {
  ServerLink to_server = link();
  core::Erosion& erosion = prepared_.erosion(1, empty_field(prepared_));
  stop_.request_stop();
  EXPECT_EQ(erode(erode_lease(prepared_, "t", 0, 256), prepared_, erosion, to_server, stop_.get_token(),
                  last_, [] {}),
            ErodeEnd::kStopped);
  EXPECT_FALSE(server_.reports().back().header.block_done());
}

TEST_F(LinkTest, ErodeObeysACancellation) {
  ServerLink to_server = link();
  core::Erosion& erosion = prepared_.erosion(1, empty_field(prepared_));
  // Many times the same directions: a task that would take long.
  v1::Lease lease = erode_lease(prepared_, "t", 0, 256);
  for (int i = 0; i < 2000; ++i) *lease.add_positions() = lease.positions(0);
  server_.on_report([](const v1::ReportErosionHeader&) {
    v1::ReportResponse response;
    response.set_cancelled(true);
    return response;
  });
  EXPECT_EQ(erode(lease, prepared_, erosion, to_server, stop_.get_token(), last_, [] {}),
            ErodeEnd::kCancelled);
  EXPECT_EQ(server_.reports().size(), 1U);
}

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
    int code = -1;
    std::thread loop([&] { code = run_lease_loop(options, stop_.get_token()); });
    server_.wait_for_idle();
    stop_.request_stop();
    loop.join();
    return code;
  }

  void offer(const v1::Lease& lease) { server_.offer(lease); }
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

// The report that fails is the first block's, on its way while the second is computed.
TEST_F(LoopTest, AFailedLastReportFailsItsOwnTask) {
  server_.fail_next("ReportErosion", {grpc::StatusCode::INTERNAL, "the numbers do not add up"});
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

TEST_F(LoopTest, FailsATaskForGoodOnABadMeshAndParameter) {
  server_.set_input(v1::ARTIFACT_KIND_MESH, "OFF\n1 0 0\n0 0\n");
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  EXPECT_EQ(run(), 0);
  ASSERT_EQ(server_.failures().size(), 1U);
  EXPECT_FALSE(server_.failures()[0].retryable());
  EXPECT_EQ(server_.failures()[0].error().code(), "BAD_INPUT");
  EXPECT_EQ(server_.failures()[0].error().line(), 3U);
}

TEST_F(LoopTest, GivesALeaseBackBeyondMaxJobs) {
  offer(other_lease("a", v1::TASK_KIND_PREPARE));
  v1::Lease second = other_lease("b", v1::TASK_KIND_PREPARE);
  second.mutable_job()->set_id("ffff");
  server_.offer(second);
  LeaseLoopOptions options;
  options.server = server_.address();
  options.max_jobs = 1;
  EXPECT_EQ(run_lease_loop(options, stop_.get_token()), 0);
  EXPECT_EQ(server_.calls("ReturnLease"), 1);
  EXPECT_EQ(server_.completions().size(), 1U);
}

TEST(LeaseLoop, LeavesWhenTheServerStaysAway) {
  LeaseLoopOptions options;
  options.server = "unix:/nonexistent/affskel.sock";
  options.patience = std::chrono::seconds(0);
  EXPECT_EQ(run_lease_loop(options, {}), 5);
}

}  // namespace
}  // namespace affskel::worker
