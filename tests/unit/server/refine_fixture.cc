#include "refine_fixture.h"

#include <cmath>

#include "wire/refined_record.h"

namespace affskel::server {
namespace {

// Whether a round finds something at a point: less and less, nothing in round 3.
bool finds(std::uint32_t point, std::uint32_t round) {
  return round == 0 || (round == 1 && point % 3 == 0) || (round == 2 && point % 100 == 7);
}

}  // namespace

double refined_erosion(std::uint32_t point, std::uint32_t round) {
  return std::ldexp(1.0, -4 - static_cast<int>(round)) + point * 1e-9;
}

namespace {

void add_record(v1::RefinedRecords& records, std::uint32_t point, std::uint32_t round) {
  records.add_point(point);
  records.add_erosion(refined_erosion(point, round));
  records.add_slope(point + 0.5);
  for (const double x : {0.6, 0.0, -0.8}) records.add_normal(x);
  records.add_saddle(point % kRefineVertices);
  records.add_saddle(wire::kNoSaddle);
}

}  // namespace

v1::RefinedRecords refined_records(std::uint32_t begin, std::uint32_t end, std::uint32_t round) {
  v1::RefinedRecords records;
  for (std::uint32_t point = begin; point < end; ++point)
    if (finds(point, round)) add_record(records, point, round);
  return records;
}

std::string expected_refined(std::uint32_t rounds) {
  std::string field(std::size_t{kRefinePoints} * wire::kRefinedRecordBytes, '\0');
  for (std::uint32_t point = 0; point < kRefinePoints; ++point) {
    wire::RefinedRecord record;
    for (std::uint32_t round = 0; round < rounds; ++round) {
      if (!finds(point, round)) continue;
      record.erosion = refined_erosion(point, round);
      record.round = round;
    }
    record.slope = point + 0.5;
    record.normal = {0.6, 0.0, -0.8};
    record.saddles[0] = point % kRefineVertices;
    wire::encode_refined_record(field.data() + std::size_t{point} * wire::kRefinedRecordBytes, record);
  }
  return field;
}

v1::Job RefineTest::submit_infimum() {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.mutable_params()->set_minimum(v1::MINIMUM_INFIMUM);
  return store_->submit(header, "OFF 1").job;
}

v1::Job RefineTest::prepare_infimum() {
  const v1::Job job = submit_infimum();
  const v1::Lease task = lease();
  PrepareResult result = prepare_result(task.token(), kRefinePoints, kRefineDirections);
  result.header.mutable_prepared()->set_vertices(kRefineVertices);
  store_->complete(result.header, result.data);
  return store_->job(job.id());
}

v1::Job RefineTest::erode_infimum() {
  const v1::Job job = prepare_infimum();
  while (store_->job(job.id()).stage() == v1::JOB_STAGE_ERODE) finish_block(lease());
  return store_->job(job.id());
}

v1::ReportErosionHeader RefineTest::header_of(const v1::Lease& lease, std::uint64_t begin, std::uint64_t end,
                                              bool done) {
  v1::ReportErosionHeader header;
  header.set_token(lease.token());
  header.set_round(lease.round());
  header.set_block_done(done);
  v1::PositionRange* range = header.add_positions_done();
  range->set_begin(begin);
  range->set_end(end);
  return header;
}

v1::ReportResponse RefineTest::report_refined(const v1::ReportErosionHeader& header,
                                              const v1::RefinedRecords& records) {
  RefinedBatch batch(store_->block_lease(header.token()).bounds);
  batch.append(records);
  return store_->report_refined(header, batch);
}

v1::ReportResponse RefineTest::report_points(const v1::Lease& lease, std::uint64_t begin, std::uint64_t end,
                                             bool done) {
  return report_refined(
      header_of(lease, begin, end, done),
      refined_records(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), lease.round()));
}

void RefineTest::finish_points(const v1::Lease& lease) {
  ASSERT_EQ(lease.kind(), v1::TASK_KIND_REFINE);
  ASSERT_EQ(lease.positions_size(), 1);
  report_points(lease, lease.positions(0).begin(), lease.positions(0).end(), true);
}

void RefineTest::finish_rounds(const std::string& job, std::uint32_t until) {
  while (store_->job(job).stage() == v1::JOB_STAGE_REFINE && store_->job(job).refine_round() < until)
    finish_points(lease());
}

std::string RefineTest::refined(const std::string& job) {
  return read_all(*store_->open_artifact(artifact_request(job, v1::ARTIFACT_KIND_REFINED)).reader);
}

}  // namespace affskel::server
