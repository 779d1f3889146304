// A worker of the driver's own that lies: its points are better than any true ones, so that a single one of
// them in the field shows.
#include <unistd.h>
#include <limits>

#include "faults.h"
#include "wire/identity.h"

namespace affskel::chaos {
namespace {

constexpr Milliseconds kReportCall{3000};
constexpr std::uint32_t kPoisoned = 400;

struct Open {
  grpc::ClientContext context;
  Open() { context.set_deadline(std::chrono::system_clock::now() + kReportCall); }
};

v1::WorkerIdentity identity(const Scene& scene) {
  v1::ServerInfo info;
  static_cast<void>(scene.stage.api().info(info, kReportCall));
  v1::WorkerIdentity worker;
  worker.set_id(wire::random_id());
  worker.set_host(wire::host_name());
  worker.set_pid(static_cast<std::uint32_t>(getpid()));
  worker.set_threads(1);
  if (info.workers_size() > 0) worker.set_core_version(info.workers(0).core_version());
  return worker;
}

void give_back(const Scene& scene, const std::string& token) {
  Open call;
  v1::ReturnLeaseRequest request;
  request.set_token(token);
  v1::ReportResponse response;
  static_cast<void>(scene.stage.api().worker().ReturnLease(&call.context, request, &response));
}

/// A block of directions of a new job of a second or two, or another; no token when there is none to be had.
v1::Lease lease_block(Scene& scene) {
  Submission urgent = scene.catalogue.next(kLongBody, scene.new_name());
  urgent.priority = 8;
  const std::string id = scene.submit_patiently(scene.stage.api(), urgent);
  scene.stage.api().follow(id, [](const v1::Job& job) { return job.directions_total() > 0; });
  v1::LeaseTaskRequest request;
  *request.mutable_worker() = identity(scene);
  request.set_wait_ms(300);
  for (int i = 0; i < 20; ++i) {
    Open call;
    v1::LeaseTaskResponse response;
    const grpc::Status status = scene.stage.api().worker().LeaseTask(&call.context, request, &response);
    if (!status.ok() || !response.has_lease()) continue;
    if (response.lease().kind() == v1::TASK_KIND_ERODE) return response.lease();
    give_back(scene, response.lease().token());
  }
  return {};
}

v1::ReportErosionRequest report_header_of(const v1::Lease& lease, std::uint32_t records) {
  v1::ReportErosionRequest message;
  v1::ReportErosionHeader& header = *message.mutable_header();
  header.set_token(lease.token());
  *header.mutable_positions_done() = lease.positions();
  header.set_block_done(true);
  header.set_records(records);
  return message;
}

v1::ReportErosionRequest poison(std::uint32_t records) {
  v1::ReportErosionRequest message;
  for (std::uint32_t point = 0; point < records; ++point) {
    message.mutable_records()->add_point(point);
    message.mutable_records()->add_direction(0);
    message.mutable_records()->add_erosion(std::numeric_limits<double>::min());
    message.mutable_records()->add_area(1);
  }
  return message;
}

}  // namespace

bool half_report(Scene& scene) {
  const v1::Lease lease = lease_block(scene);
  if (lease.token().empty()) return false;
  Open call;
  v1::ReportResponse response;
  const auto writer = scene.stage.api().worker().ReportErosion(&call.context, &response);
  writer->Write(report_header_of(lease, 2 * kPoisoned));
  writer->Write(poison(kPoisoned));
  if (scene.pick(2) == 0) {
    writer->WritesDone();
  } else {
    outlast_lease();
    call.context.TryCancel();
  }
  if (writer->Finish().ok()) scene.complain("half a report was taken");
  return true;
}

bool late_report(Scene& scene) {
  const v1::Lease lease = lease_block(scene);
  if (lease.token().empty()) return false;
  outlast_lease();
  Open renewal;
  v1::RenewLeaseRequest renew;
  renew.set_token(lease.token());
  v1::ReportResponse response;
  const grpc::Status renewed = scene.stage.api().worker().RenewLease(&renewal.context, renew, &response);
  if (renewed.error_code() != grpc::StatusCode::ABORTED &&
      renewed.error_code() != grpc::StatusCode::NOT_FOUND) {
    give_back(scene, lease.token());  // no worker wanted it: it is still ours, and a lie would be believed
    return false;
  }
  Open call;
  const auto writer = scene.stage.api().worker().ReportErosion(&call.context, &response);
  writer->Write(report_header_of(lease, kPoisoned));
  writer->Write(poison(kPoisoned));
  writer->WritesDone();
  if (writer->Finish().ok()) scene.complain("a report was taken after its lease was lost");
  return true;
}

bool poisoned_report(Scene& scene) {
  const v1::Lease lease = lease_block(scene);
  if (lease.token().empty()) return false;
  Open call;
  v1::ReportResponse response;
  const auto writer = scene.stage.api().worker().ReportErosion(&call.context, &response);
  writer->Write(report_header_of(lease, kPoisoned));
  writer->Write(poison(kPoisoned));
  writer->WritesDone();
  return writer->Finish().ok();
}

bool job_deleted_in_secret(Scene& scene) {
  const std::string id =
      scene.submit_patiently(scene.stage.api(), scene.catalogue.next(kTiny, scene.new_name()));
  scene.stage.api().follow(id, [](const v1::Job&) { return false; });
  return scene.stage.api().remove(id, kReportCall).ok();
}

}  // namespace affskel::chaos
