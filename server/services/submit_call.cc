#include "services/submit_call.h"

#include <utility>

#include "database/errors.h"
#include "services/job_access.h"

namespace affskel::server {
namespace {

[[noreturn]] void refuse_mesh_without_header() {
  throw StoreError(StoreError::Code::kInvalid, "a submission begins with its header");
}

}  // namespace

void SubmitCall::on_message(v1::SubmitJobRequest& message) {
  if (mesh_) {
    try {
      mesh_->add_message(message);
    } catch (const CallEnded&) {
      room().relieve_uploads();
      throw;
    }
    return;
  }
  if (!message.has_header()) refuse_mesh_without_header();
  // Before the data, which may take minutes to arrive.
  v1::SubmitJobHeader& header = *message.mutable_header();
  header.set_owner(owner_of_submission(header.owner(), caller().identity));
  submission_ = store_.check(header);
  mesh_.emplace(room().upload_bytes, announced_bytes(submission_->header), room().upload_bytes.limit() / 4);
}

void SubmitCall::on_end() {
  if (!mesh_) refuse_mesh_without_header();
  if (is_cancelled()) throw CallEnded(grpc::Status::CANCELLED);
  Store::Submitted submitted = store_.submit(*submission_, mesh_->data());
  *response_.mutable_job() = jobs_.with_reason(std::move(submitted.job));
  response_.set_existed(submitted.existed);
}

}  // namespace affskel::server
