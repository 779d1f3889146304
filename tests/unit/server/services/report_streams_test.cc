// Reports of workers, in as many messages as they take.
#include <cmath>
#include <cstring>
#include <fstream>
#include <list>

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
  ASSERT_TRUE(writers[1]->Write(records(4000, 8.0)));
  while (std::isinf(first_erosion(lease))) std::this_thread::yield();
  for (int i = 0; i < 2; ++i) {
    contexts[i].TryCancel();
    writers[i]->Finish();
  }
}

}  // namespace
}  // namespace affskel::server
