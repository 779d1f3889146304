#include "tasks/erode_task.h"

#include <set>

#include "link_fixture.h"
#include "wire/erosion_bound.h"

namespace affskel::worker {
namespace {

class ErodeTest : public LinkTest {};

TEST_F(ErodeTest, ReportsEveryPositionOnceAndAllItsPoints) {
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
TEST_F(ErodeTest, ReportsNothingThatAnotherWorkerHasOutdone) {
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
TEST_F(ErodeTest, ReportsNothingAfterALostBlock) {
  ServerLink to_server = link();
  core::Erosion& erosion = prepared_.erosion(1, empty_field(prepared_));
  last_.start("before", [] { throw LeaseLost("fenced"); });
  EXPECT_THROW(erode(erode_lease(prepared_, "t", 0, 256), prepared_, erosion, to_server, stop_.get_token(),
                     last_, [] {}),
               LeaseLost);
  EXPECT_EQ(server_.calls("ReportErosion"), 0);
}

TEST_F(ErodeTest, StopsWithEverythingReportedThatIsDone) {
  ServerLink to_server = link();
  core::Erosion& erosion = prepared_.erosion(1, empty_field(prepared_));
  stop_.request_stop();
  EXPECT_EQ(erode(erode_lease(prepared_, "t", 0, 256), prepared_, erosion, to_server, stop_.get_token(),
                  last_, [] {}),
            ErodeEnd::kStopped);
  EXPECT_FALSE(server_.reports().back().header.block_done());
}

TEST_F(ErodeTest, ObeysACancellation) {
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

// The first report of a large field goes in parts, of which only the last calls anything done; what the answers to the
// others tell is not reported any more.
TEST_F(ErodeTest, MakesALargeReportInParts) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_target_points(300000);
  params.set_directions("sphere:32");
  PreparedJob job(sample_mesh(), params);
  const auto reported = [&](bool answered) {
    PreparedJob one(sample_mesh(), params);
    core::Erosion& erosion = one.erosion(1, {});
    v1::Lease lease = erode_lease(one, "t", 0, one.directions().size());
    lease.set_report_interval_ms(60000);
    server_.on_report([&](const v1::ReportErosionHeader&) {
      v1::ReportResponse response;
      v1::ErosionBounds* bounds = response.add_bounds();
      for (std::uint32_t p = 0; answered && p < one.lattice().points; ++p) {
        bounds->add_step(p == 0 ? 0 : 1);
        bounds->add_bound(wire::bound_above(1e-3));
      }
      return response;
    });
    const std::size_t before = server_.reports().size();
    ServerLink to_server = link();
    EXPECT_EQ(erode(lease, one, erosion, to_server, stop_.get_token(), last_, [] {}), ErodeEnd::kBlockDone);
    last_.wait();
    const std::vector<FakeServer::Report> reports = server_.reports();
    return std::vector<FakeServer::Report>(reports.begin() + static_cast<std::ptrdiff_t>(before),
                                           reports.end());
  };
  const std::vector<FakeServer::Report> all = reported(false), few = reported(true);
  ASSERT_EQ(all.size(), 3U);
  std::set<std::uint32_t> points;
  for (const FakeServer::Report& report : all) {
    const bool last = &report == &all.back();
    EXPECT_EQ(report.header.block_done(), last);
    EXPECT_EQ(report.header.positions_done().empty(), !last);
    EXPECT_NEAR(report.records.point_size(), job.lattice().points / 3.0, 100);
    points.insert(report.records.point().begin(), report.records.point().end());
  }
  EXPECT_EQ(points.size(), job.lattice().points);
  ASSERT_EQ(few.size(), 3U);
  EXPECT_EQ(few[1].records.point_size() + few[2].records.point_size(), 0) << "outdone";
  EXPECT_EQ(positions(few).size(), job.directions().size());
}

}  // namespace
}  // namespace affskel::worker
