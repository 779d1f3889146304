// Reports of workers, in as many messages as they take.
#include <cmath>
#include <cstring>
#include <fstream>
#include <list>

#include "refine_fixture.h"
#include "service_fixture.h"

namespace affskel::server {
namespace {

/// Of this process, the client's and gRPC's included.
int thread_count() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "Threads:") continue;
    int count = 0;
    status >> count;
    return count;
  }
  return -1;
}

TEST_F(ServiceTest, StreamsHoldNoThreads) {
  std::vector<std::unique_ptr<v1::WorkerService::Stub>> stubs;
  for (int i = 0; i < 4; ++i) stubs.push_back(v1::WorkerService::NewStub(connect()));
  poll(0);
  const int before = thread_count();
  struct Report {
    grpc::ClientContext context;
    v1::ReportResponse response;
    std::unique_ptr<grpc::ClientWriter<v1::ReportErosionRequest>> writer;
  };
  std::list<Report> reports;
  for (std::size_t i = 0; i < 600; ++i) {
    Report& report = reports.emplace_back();
    report.writer = stubs[i % stubs.size()]->ReportErosion(&report.context, &report.response);
  }
  while (server_->room().reports.used() < 600) std::this_thread::yield();
  EXPECT_LT(thread_count(), before + 20);
  EXPECT_FALSE(poll(0).has_lease()) << "all else is served";
  for (Report& report : reports) report.context.TryCancel();
  for (Report& report : reports) report.writer->Finish();
}

class ReportStreams : public ServiceTest {
 protected:
  v1::Lease block(std::uint32_t points, std::uint32_t directions) {
    submit();
    const PrepareResult result = prepare_result(poll(0).lease().token(), points, directions);
    EXPECT_TRUE(send_result(*worker_, result.header, result.data).ok());
    return poll(0).lease();
  }

  static v1::ReportErosionRequest header(const v1::Lease& lease, std::uint64_t records) {
    v1::ReportErosionRequest message;
    message.mutable_header()->set_token(lease.token());
    v1::PositionRange& range = *message.mutable_header()->add_positions_done();
    range.set_begin(0);
    range.set_end(1);
    message.mutable_header()->set_records(records);
    return message;
  }

  /// As many records as a message may have, of the first points.
  static v1::ReportErosionRequest records(std::uint32_t points, double erosion) {
    v1::ReportErosionRequest message;
    for (std::uint32_t i = 0; i < 32768; ++i) {
      message.mutable_records()->add_point(i % points);
      message.mutable_records()->add_direction(0);
      message.mutable_records()->add_erosion(erosion);
      message.mutable_records()->add_area(1);
    }
    return message;
  }

  /// E of the first point, as merged so far.
  double first_erosion(const v1::Lease& lease) {
    grpc::ClientContext context;
    v1::FetchInputRequest request;
    request.set_token(lease.token());
    request.set_kind(v1::ARTIFACT_KIND_FIELD);
    const auto reader = worker_->FetchInput(&context, request);
    std::string field;
    for (v1::FetchArtifactResponse message; reader->Read(&message);) field += message.data();
    EXPECT_TRUE(reader->Finish().ok());
    double erosion = -1;
    if (field.size() >= sizeof erosion) std::memcpy(&erosion, field.data(), sizeof erosion);
    return erosion;
  }
};

TEST_F(ReportStreams, AreMergedInPartsAndCountOnlyWhenComplete) {
  const v1::Lease lease = block(4000, 40);
  EXPECT_TRUE(std::isinf(first_erosion(lease)));
  grpc::ClientContext context;
  v1::ReportResponse response;
  const auto writer = worker_->ReportErosion(&context, &response);
  ASSERT_TRUE(writer->Write(header(lease, 0)));
  // One more than are held: the fifth finds the batch full.
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(writer->Write(records(4000, 9.0 - i)));
  while (std::isinf(first_erosion(lease))) std::this_thread::yield();
  EXPECT_EQ(first_erosion(lease), 6.0) << "four of five are merged";
  context.TryCancel();
  writer->Finish();
  EXPECT_EQ(job(lease.job().id()).directions_done(), 0U);
}

TEST_F(ReportStreams, AreCountedOverAllParts) {
  const v1::Lease lease = block(4000, 40);
  const auto report = [&](std::uint64_t announced) {
    grpc::ClientContext context;
    v1::ReportResponse response;
    const auto writer = worker_->ReportErosion(&context, &response);
    writer->Write(header(lease, announced));
    for (int i = 0; i < 6; ++i) writer->Write(records(4000, 9.0 - i));
    writer->WritesDone();
    return writer->Finish();
  };
  EXPECT_EQ(report(6 * 32768 + 1).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(job(lease.job().id()).directions_done(), 0U);
  const grpc::Status complete = report(6 * 32768);
  EXPECT_TRUE(complete.ok()) << complete.error_message();
  EXPECT_EQ(job(lease.job().id()).directions_done(), 1U);
  EXPECT_EQ(first_erosion(lease), 4.0);
}

TEST_F(ReportStreams, TogetherHoldNoMoreThanTheirBudget) {
  options_.limits.records_bytes = 40000 * sizeof(wire::PointRecord);
  start();
  const v1::Lease lease = block(4000, 40);
  grpc::ClientContext contexts[2];
  v1::ReportResponse response;
  std::unique_ptr<grpc::ClientWriter<v1::ReportErosionRequest>> writers[2];
  for (int i = 0; i < 2; ++i) {
    writers[i] = worker_->ReportErosion(&contexts[i], &response);
    ASSERT_TRUE(writers[i]->Write(header(lease, 0)));
    ASSERT_TRUE(writers[i]->Write(records(4000, 9.0)));
  }
  // The first waits for more; what finds no room beside it does not.
  while (std::isinf(first_erosion(lease))) std::this_thread::yield();
  for (int i = 0; i < 2; ++i) {
    contexts[i].TryCancel();
    writers[i]->Finish();
  }
}

class RefinementReports : public ReportStreams {
 protected:
  /// The first block of round 0.
  v1::Lease points_block() {
    v1::SubmitJobHeader header = submit_header("OFF 1");
    header.mutable_params()->set_minimum(v1::MINIMUM_INFIMUM);
    v1::SubmitJobResponse submitted;
    EXPECT_TRUE(submit_mesh(*client_, header, "OFF 1", &submitted).ok());
    PrepareResult result = prepare_result(poll(0).lease().token(), kRefinePoints, kRefineDirections);
    result.header.mutable_prepared()->set_vertices(kRefineVertices);
    EXPECT_TRUE(send_result(*worker_, result.header, result.data).ok());
    for (;;) {
      const v1::Lease lease = poll(0).lease();
      if (lease.kind() != v1::TASK_KIND_ERODE) return lease;
      v1::ReportResponse response;
      const v1::PositionRange& range = lease.positions(0);
      EXPECT_TRUE(send_report(*worker_, lease, range.begin(), range.end(), true, &response).ok());
    }
  }

  /// A report that calls the first points done.
  grpc::Status report_points(const v1::Lease& lease, std::uint64_t points, std::uint32_t round,
                             const std::vector<v1::ReportErosionRequest>& messages) {
    grpc::ClientContext context;
    v1::ReportResponse response;
    v1::ReportErosionRequest first;
    first.mutable_header()->set_token(lease.token());
    first.mutable_header()->set_round(round);
    first.mutable_header()->add_positions_done()->set_end(points);
    const auto writer = worker_->ReportErosion(&context, &response);
    writer->Write(first);
    for (const v1::ReportErosionRequest& message : messages) writer->Write(message);
    writer->WritesDone();
    return writer->Finish();
  }

  static v1::ReportErosionRequest refined(std::uint32_t begin, std::uint32_t end) {
    v1::ReportErosionRequest message;
    *message.mutable_refined() = refined_records(begin, end, 0);
    return message;
  }
};

TEST_F(RefinementReports, HaveOneMessageOfTheirKind) {
  const v1::Lease lease = points_block();
  ASSERT_EQ(lease.kind(), v1::TASK_KIND_REFINE);
  const auto code = [&](std::uint32_t round, const std::vector<v1::ReportErosionRequest>& messages) {
    return report_points(lease, 100, round, messages).error_code();
  };
  EXPECT_EQ(code(0, {records(100, 0.1)}), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code(0, {refined(0, 50), refined(50, 100)}), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code(1, {refined(0, 100)}), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code(0, {refined(0, 101)}), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code(0, {}), grpc::StatusCode::INVALID_ARGUMENT);
  v1::ReportErosionRequest many;
  while (many.refined().point_size() <= 32768) many.mutable_refined()->MergeFrom(refined_records(0, 5000, 0));
  EXPECT_EQ(code(0, {many}), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(job(lease.job().id()).refined_points(), 0U);
  EXPECT_EQ(code(0, {refined(0, 100)}), grpc::StatusCode::OK);
  EXPECT_EQ(job(lease.job().id()).refined_points(), 100U);
  EXPECT_EQ(job(lease.job().id()).stage(), v1::JOB_STAGE_REFINE);
}

TEST_F(RefinementReports, AreNoneOnDirections) {
  const v1::Lease lease = block(4000, 40);
  EXPECT_EQ(report_points(lease, 1, 0, {refined(0, 100)}).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(RefinementReports, WaitForTheMemoryThatTheyTake) {
  options_.limits.records_bytes = 1000;
  start();
  const v1::Lease lease = points_block();
  EXPECT_EQ(report_points(lease, 100, 0, {refined(0, 100)}).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(report_points(lease, 10, 0, {refined(0, 10)}).error_code(), grpc::StatusCode::OK);
}

}  // namespace
}  // namespace affskel::server
