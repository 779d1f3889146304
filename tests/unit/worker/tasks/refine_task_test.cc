#include "tasks/refine_task.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/execution_context.h"
#include "core/shapes/body.h"
#include "core/text/off_file.h"
#include "job/job_refinement.h"
#include "link_fixture.h"
#include "wire/refined_record.h"

namespace affskel::worker {
namespace {

// With limbs: what one point finds, others take up.
const std::string& limbed_mesh() {
  static const std::string mesh = core::write_off(core::make_body({.triangles = 200}));
  return mesh;
}

v1::ErosionParams limbed_params() {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(35);
  return params;
}

class RefineTaskTest : public LinkTest {
 protected:
  RefineTaskTest() { server_.set_input(v1::ARTIFACT_KIND_FIELD, finished_field(job_)); }

  v1::Lease refine_lease(std::uint32_t round, std::uint64_t begin, std::uint64_t end) const {
    v1::Lease lease = derive_lease(job_, "t", v1::TASK_KIND_REFINE);
    lease.set_round(round);
    v1::PositionRange* range = lease.add_positions();
    range->set_begin(begin);
    range->set_end(end);
    return lease;
  }

  void run(const v1::Lease& lease) {
    ServerLink to_server = link();
    TaskContext context(stop_.get_token());
    refine(lease, job_, 2, to_server, context, last_, [this] {
      done_before_told_ = positions(server_.reports()).size();
      ++told_;
    });
    last_.wait();
  }

  static void append_to(std::string& bytes, const wire::RefinedPointRecord& record) {
    char packed[wire::kRefinedPointRecordBytes];
    wire::encode_refined_point_record(packed, record);
    bytes.append(packed, sizeof packed);
  }

  // As the server sends a whole field.
  static std::string without_points(const std::string& named) {
    std::string records;
    for (std::size_t at = 4; at < named.size(); at += wire::kRefinedPointRecordBytes)
      records += named.substr(at, wire::kRefinedRecordBytes);
    return records;
  }

  // What the reports from `first` on found in this round, by point.
  std::string found(std::size_t first, std::uint32_t round) const {
    std::map<std::uint32_t, wire::RefinedRecord> all;
    const std::vector<FakeServer::Report> reports = server_.reports();
    for (std::size_t r = first; r < reports.size(); ++r) {
      const v1::RefinedRecords& records = reports[r].refined;
      EXPECT_EQ(reports[r].header.records(), static_cast<std::uint64_t>(records.point_size()));
      EXPECT_EQ(reports[r].header.round(), round);
      for (int i = 0; i < records.point_size(); ++i) {
        wire::RefinedRecord& record = all[records.point(i)];
        record.erosion = records.erosion(i);
        record.slope = records.slope(i);
        for (int a = 0; a < 3; ++a) record.normal[static_cast<std::size_t>(a)] = records.normal(3 * i + a);
        for (int n = 0; n < 2; ++n) record.saddles[static_cast<std::size_t>(n)] = records.saddle(2 * i + n);
        record.round = round;
      }
    }
    std::string bytes;
    for (const auto& [point, record] : all) append_to(bytes, {point, record});
    return bytes;
  }

  std::uint32_t points() const { return job_.lattice().points; }

  PreparedJob job_{limbed_mesh(), limbed_params()};
  int told_ = 0;  // that a block is nearly done
  std::size_t done_before_told_ = 0;
};

// Block by block and round by round, as a server leads it, against each round as a whole.
TEST_F(RefineTaskTest, GivesWhatTheCoreGives) {
  const SolidUnits units{job_.volume_unit(), job_.area_unit()};
  JobRefinement whole(job_.solid(), job_.lattice(), units, 1);
  whole.take_seeds(finished_field(job_));
  core::ExecutionContext context;
  const auto seed = [&](std::uint32_t point) { return whole.seeds()[point]; };
  const core::PointRange all{0, points()};
  std::uint32_t round = 0;
  for (std::string news;; ++round) {
    const std::size_t before = server_.reports().size();
    // Small blocks: what one has found must not be seen by the next of its round.
    for (std::uint32_t end = points(); end > 0; end -= std::min(end, 40U))
      run(refine_lease(round, end - std::min(end, 40U), end));
    std::string expected;
    for (const core::RefinedPoint& point :
         round == 0 ? whole.rounds().descend(job_.directions(), seed, all, context)
                    : whole.rounds().improve(static_cast<int>(round), all, context)) {
      whole.rounds().set(point, static_cast<int>(round));
      append_to(expected, {point.point, refined_record(point.least, units, round)});
    }
    news = found(before, round);
    ASSERT_TRUE(news == expected) << "round " << round;
    if (news.empty()) break;
    server_.set_input(v1::ARTIFACT_KIND_REFINED, round == 0 ? without_points(news) : news);
  }
  EXPECT_GT(round, 1U);
}

TEST_F(RefineTaskTest, CallsEveryPointDoneOnceAndTheBlockAtTheEnd) {
  server_.fail_next("ReportErosion", {grpc::StatusCode::UNAVAILABLE, "away"}, 2);
  v1::Lease lease = refine_lease(0, 0, 100);
  v1::PositionRange* rest = lease.add_positions();
  rest->set_begin(150);
  rest->set_end(points());
  run(lease);
  const std::vector<FakeServer::Report> reports = server_.reports();
  EXPECT_TRUE(reports.back().header.block_done());
  const std::vector<std::uint64_t> done = positions(reports);
  ASSERT_EQ(done.size(), points() - 50U);
  for (std::uint64_t i = 0; i < done.size(); ++i) EXPECT_EQ(done[i], i < 100 ? i : i + 50);
}

TEST_F(RefineTaskTest, TellsOnceThatABlockIsNearlyDoneBeforeItsLastReport) {
  run(refine_lease(0, 0, points()));
  EXPECT_EQ(told_, 1);
  EXPECT_LT(done_before_told_, points());
}

TEST_F(RefineTaskTest, AWorkerThatStopsReportsWhatIsDone) {
  v1::Lease lease = refine_lease(0, 0, points());
  lease.set_report_interval_ms(0);  // the first report comes after the first points
  server_.on_report([&](const v1::ReportErosionHeader&) {
    stop_.request_stop();
    return v1::ReportResponse();
  });
  EXPECT_THROW(run(lease), core::CoreError);
  const std::vector<FakeServer::Report> reports = server_.reports();
  std::uint64_t records = 0;
  for (const FakeServer::Report& report : reports) {
    EXPECT_FALSE(report.header.block_done());
    records += report.header.records();
  }
  EXPECT_EQ(positions(reports).size(), records);
  EXPECT_GT(records, 0U);
}

TEST_F(RefineTaskTest, EndsWhenItsJobIsCancelled) {
  v1::Lease lease = refine_lease(0, 0, points());
  lease.set_report_interval_ms(0);
  server_.on_report([](const v1::ReportErosionHeader&) {
    v1::ReportResponse response;
    response.set_cancelled(true);
    return response;
  });
  EXPECT_THROW(run(lease), core::CoreError);
}

TEST_F(RefineTaskTest, RefusesAFieldThatIsNotOfTheJob) {
  std::string record(wire::kRefinedRecordBytes, '\0');
  wire::encode_refined_record(record.data(), {1, 1, {1, 0, 0}, {1U << 30, wire::kNoSaddle}, 0});
  std::string field;
  for (std::uint32_t p = 0; p < points(); ++p) field += record;
  for (const std::string& wrong : {field, field.substr(1), std::string()}) {
    server_.set_input(v1::ARTIFACT_KIND_REFINED, wrong);
    EXPECT_THROW(run(refine_lease(1, 0, points())), core::CoreError);
  }
  EXPECT_TRUE(server_.reports().empty());
}

}  // namespace
}  // namespace affskel::worker
