// What workers on one field learn from each other's reports, and what they must not.
#include "service_fixture.h"

namespace affskel::server {
namespace {

constexpr std::uint32_t kBoundPoints = 10;

class BoundsTest : public ServiceTest {
 protected:
  void SetUp() override {
    job_ = submit();
    const PrepareResult result = prepare_result(poll(0, "honest").lease().token(), kBoundPoints, 64);
    ASSERT_TRUE(send_result(*worker_, result.header, result.data).ok());
  }

  v1::Lease block_of(const std::string& worker) {
    v1::Lease lease = poll(0, worker).lease();
    EXPECT_EQ(lease.kind(), v1::TASK_KIND_ERODE);
    return lease;
  }

  /// Reports one value of E at all points, of none when it is 0, and tells how many bounds the answer has.
  int bounds_after(const v1::Lease& lease, const std::string& bounds_for, double erosion, bool done = false) {
    grpc::ClientContext context;
    v1::ReportResponse response;
    const auto writer = worker_->ReportErosion(&context, &response);
    v1::ReportErosionRequest message;
    v1::ReportErosionHeader& header = *message.mutable_header();
    header.set_token(lease.token());
    header.set_bounds_for(bounds_for);
    header.set_block_done(done);
    if (done) *header.mutable_positions_done() = lease.positions();
    writer->Write(message);
    for (std::uint32_t point = 0; erosion > 0 && point < kBoundPoints; ++point) {
      v1::FieldRecords& records = *message.mutable_records();
      records.add_point(point);
      records.add_direction(0);
      records.add_erosion(erosion);
      records.add_area(1);
    }
    if (erosion > 0) writer->Write(message);
    writer->WritesDone();
    const grpc::Status status = writer->Finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
    int points = 0;
    for (const v1::ErosionBounds& bounds : response.bounds()) points += bounds.step_size();
    return points;
  }

  void distrust(const std::string& worker) {
    grpc::ClientContext context;
    v1::ResumeJobRequest request;
    request.set_job(job_);
    request.set_distrust(worker);
    v1::Job resumed;
    const grpc::Status status = client_->ResumeJob(&context, request, &resumed);
    EXPECT_TRUE(status.ok()) << status.error_message();
  }

  /// A job of higher priority, all of it by one worker.
  std::string done_by(const std::string& worker) {
    v1::SubmitJobHeader header = submit_header("OFF other", "other");
    header.set_priority(9);
    v1::SubmitJobResponse submitted;
    EXPECT_TRUE(submit_mesh(*client_, header, "OFF other", &submitted).ok());
    for (v1::Lease lease = poll(0, worker).lease(); lease.job().id() == submitted.job().id();
         lease = poll(0, worker).lease()) {
      v1::ReportResponse response;
      if (lease.kind() == v1::TASK_KIND_PREPARE) {
        const PrepareResult result = prepare_result(lease.token(), kBoundPoints, 16);
        EXPECT_TRUE(send_result(*worker_, result.header, result.data).ok());
      } else if (lease.kind() == v1::TASK_KIND_ERODE) {
        EXPECT_TRUE(send_report(*worker_, lease, 0, 16, true, &response).ok());
      } else {
        EXPECT_TRUE(send_result(*worker_, derive_header(lease.token(), "skeleton", 3), "skeleton").ok());
      }
    }
    return submitted.job().id();
  }

  std::string job_;
};

// What was taken out of the field would rule out what is true, and nobody would compute it again.
TEST_F(BoundsTest, OfADistrustedWorkerNobodyHears) {
  const v1::Lease lie = block_of("liar"), block = block_of("honest");
  EXPECT_EQ(bounds_after(block, "honest", 0), 0);
  EXPECT_EQ(bounds_after(lie, "liar", 0.01), 0);
  distrust("liar");
  const v1::Lease again = block_of("honest"), other = block_of("another");
  EXPECT_EQ(bounds_after(again, "honest", 0), 0);
  EXPECT_EQ(bounds_after(other, "another", 2), 0);
  EXPECT_EQ(bounds_after(again, "honest", 0), static_cast<int>(kBoundPoints)) << "those of now are told";
}

// It asks for work still, and gets none.
TEST_F(BoundsTest, AVerificationDoesNotCountOnADistrustedWorker) {
  const v1::Lease lie = block_of("liar");
  EXPECT_EQ(bounds_after(lie, "liar", 2, true), 0);
  const std::string other = done_by("honest");
  const auto reason = [&] {
    grpc::ClientContext context;
    v1::VerifyJobRequest request;
    request.set_job(other);
    v1::Verification verification;
    EXPECT_TRUE(client_->VerifyJob(&context, request, &verification).ok());
    return verification.waiting_reason();
  };
  EXPECT_EQ(reason(), "");
  distrust("liar");
  EXPECT_NE(reason().find("needs a worker that did not give"), std::string::npos) << reason();
}

// A report is repeated when its answer was lost; what it says the second time is stored nowhere, and of nobody.
TEST_F(BoundsTest, OfARepeatedLastReportNobodyHears) {
  const v1::Lease ending = block_of("ending"), block = block_of("other");
  EXPECT_EQ(bounds_after(block, "other", 0), 0);
  EXPECT_EQ(bounds_after(ending, "ending", 2, true), 0);
  EXPECT_EQ(bounds_after(block, "other", 3), static_cast<int>(kBoundPoints));
  EXPECT_EQ(bounds_after(ending, "ending", 0.01, true), static_cast<int>(kBoundPoints)) << "it hears itself";
  EXPECT_EQ(bounds_after(block, "other", 0), 0);
}

// Else who makes up names is remembered under each, and told what it has said itself.
TEST_F(BoundsTest, WhoReportsIsTakenFromTheLease) {
  const v1::Lease block = block_of("worker"), other = block_of("other");
  EXPECT_EQ(bounds_after(block, "worker", 0), 0);
  EXPECT_EQ(bounds_after(block, "made up", 2), 0);
  EXPECT_EQ(bounds_after(block, "worker", 0), 0) << "its own";
  EXPECT_EQ(bounds_after(other, std::string(1000, 'x'), 0), static_cast<int>(kBoundPoints));
}

}  // namespace
}  // namespace affskel::server
