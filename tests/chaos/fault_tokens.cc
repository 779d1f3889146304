// Tokens revoked in mid-stream.  What was acknowledged before holds, whichever caller it was told to.
#include "faults.h"

namespace affskel::chaos {
namespace {

constexpr Milliseconds kTokenCall{20000};

void must_be_refused(const char* what, const grpc::Status& status) {
  // A call that the network or a restart ended first is none of the gate's.
  if (status.error_code() == grpc::StatusCode::UNAUTHENTICATED || worth_repeating(status)) return;
  throw std::runtime_error(std::string(what) + " by a token that was revoked ended with status " +
                           std::to_string(static_cast<int>(status.error_code())) + ", " +
                           status.error_message());
}

/// An upload that stands still in the middle.
struct HalfUpload {
  HalfUpload(const Api& api, const Submission& submission) {
    context.set_deadline(std::chrono::system_clock::now() + kTokenCall);
    writer = api.client().SubmitJob(&context, &response);
    v1::SubmitJobRequest message;
    v1::SubmitJobHeader& header = *message.mutable_header();
    header.set_name(submission.name);
    *header.mutable_params() = submission.params;
    header.set_mesh_sha256(submission.mesh_sha256);
    header.set_mesh_bytes(submission.mesh.size());
    writer->Write(message);
    message.set_data(submission.mesh.substr(0, submission.mesh.size() / 2));
    writer->Write(message);
  }

  grpc::ClientContext context;
  v1::SubmitJobResponse response;
  std::unique_ptr<grpc::ClientWriter<v1::SubmitJobRequest>> writer;
};

}  // namespace

bool revoke_worker(Scene& scene) {
  scene.stage.revoke_token(kWorkerOwner);
  const auto code = scene.stage.worker(0).wait(kPatience);
  scene.stage.renew_token(kWorkerOwner);
  if (!code) throw Hang("a worker whose token was revoked does not leave");
  if (*code != 7)
    throw std::runtime_error("a worker whose token was revoked ended with " + std::to_string(*code));
  return true;
}

bool revoke_client(Scene& scene) {
  const Api& api = scene.stage.proxied();
  HalfUpload upload(api, scene.catalogue.next(kLongBody, scene.new_name()));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kTokenCall);
  v1::WatchJobRequest request;
  request.set_job(scene.running_job);
  const auto watch = api.client().WatchJob(&context, request);
  v1::Job seen;
  const bool watching = watch->Read(&seen);
  scene.stage.revoke_token(kClientOwner);
  while (watch->Read(&seen)) {
  }
  const grpc::Status watched = watch->Finish();
  const grpc::Status uploaded = upload.writer->Finish();
  scene.stage.renew_token(kClientOwner);
  if (!is_final(seen)) must_be_refused("a watch", watched);
  must_be_refused("an upload", uploaded);
  return watching;
}

}  // namespace affskel::chaos
