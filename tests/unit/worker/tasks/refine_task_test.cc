#include "tasks/refine_task.h"

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/execution_context.h"
#include "core/infimum/refine.h"
#include "core/shapes/body.h"
#include "core/text/off_file.h"
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
    refine(lease, job_, 2, to_server, context);
  }

  // What the reports from `first` on found, as records of this round.
  std::string found(std::size_t first, std::uint32_t round, bool named) const {
    std::string bytes;
    const std::vector<FakeServer::Report> reports = server_.reports();
    for (std::size_t r = first; r < reports.size(); ++r) {
      const v1::RefinedRecords& records = reports[r].refined;
      EXPECT_EQ(reports[r].header.records(), static_cast<std::uint64_t>(records.point_size()));
      EXPECT_EQ(reports[r].header.round(), round);
      for (int i = 0; i < records.point_size(); ++i) {
        wire::RefinedPointRecord record{records.point(i), {}};
        record.record.erosion = records.erosion(i);
        record.record.slope = records.slope(i);
        for (int a = 0; a < 3; ++a)
          record.record.normal[static_cast<std::size_t>(a)] = records.normal(3 * i + a);
        for (int n = 0; n < 2; ++n)
          record.record.saddles[static_cast<std::size_t>(n)] = records.saddle(2 * i + n);
        record.record.round = round;
        char packed[wire::kRefinedPointRecordBytes];
        wire::encode_refined_point_record(packed, record);
        bytes.append(named ? packed : packed + 4, named ? sizeof packed : wire::kRefinedRecordBytes);
      }
    }
    return bytes;
  }

  std::uint32_t points() const { return job_.lattice().points; }

  PreparedJob job_{limbed_mesh(), limbed_params()};
};

// Block by block and round by round, as a server leads it, against the same in one call.
TEST_F(RefineTaskTest, GivesWhatTheCoreGives) {
  std::string field;
  std::uint32_t round = 0;
  for (std::string news;; ++round) {
    const std::size_t before = server_.reports().size();
    run(refine_lease(round, points() / 3, points()));
    run(refine_lease(round, 0, points() / 3));
    news = found(before, round, true);
    if (round == 0) {
      // The second block comes first in the field.
      const std::string all = found(before, 0, false);
      const std::size_t second = (points() - points() / 3) * wire::kRefinedRecordBytes;
      ASSERT_EQ(all.size(), points() * wire::kRefinedRecordBytes);
      field = all.substr(second) + all.substr(0, second);
    }
    for (std::size_t at = 0; at < news.size(); at += wire::kRefinedPointRecordBytes) {
      const wire::RefinedPointRecord named = wire::decode_refined_point_record(news.data() + at);
      field.replace(named.point * wire::kRefinedRecordBytes, wire::kRefinedRecordBytes, news, at + 4,
                    wire::kRefinedRecordBytes);
    }
    if (news.empty()) break;
    server_.set_input(v1::ARTIFACT_KIND_REFINED, round == 0 ? field : news);
  }
  EXPECT_GT(round, 1U);
  core::ErosionField seeds(points(), false);
  const std::vector<core::FieldValue> stored = unpack_field(finished_field(job_), points());
  const SolidUnits units{job_.volume_unit(), job_.area_unit()};
  for (std::uint32_t p = 0; p < points(); ++p)
    seeds.offer(p, {stored[p].erosion / units.volume, stored[p].area / units.area, stored[p].direction});
  core::ExecutionContext context;
  const std::vector<core::LeastChord> expected =
      core::refine(core::PieceInput(job_.solid()), job_.lattice(), job_.directions(), seeds, {}, context);
  for (std::uint32_t p = 0; p < points(); ++p) {
    const wire::RefinedRecord record =
        wire::decode_refined_record(field.data() + p * wire::kRefinedRecordBytes);
    const wire::RefinedRecord right = refined_record(expected[p], units, record.round);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(record.erosion), std::bit_cast<std::uint64_t>(right.erosion));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(record.slope), std::bit_cast<std::uint64_t>(right.slope));
    EXPECT_EQ(record.normal, right.normal);
    EXPECT_EQ(record.saddles, right.saddles);
  }
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
