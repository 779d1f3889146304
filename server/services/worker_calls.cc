#include "services/worker_calls.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "database/errors.h"
#include "wire/limits.h"

namespace affskel::server {
namespace {

[[noreturn]] void refuse(const char* why) {
  throw StoreError(StoreError::Code::kInvalid, why);
}

[[noreturn]] void refuse_without_header() {
  refuse("the first message must be the header");
}

}  // namespace

ReportCall::ReportCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store,
                       WorkerRegistry& registry, BoundsExchange& bounds, v1::ReportResponse& response)
    : Receiving(room, room.worker_calls, context, Method::kReportErosion, room.reports),
      store_(store),
      registry_(registry),
      bounds_(bounds),
      response_(response),
      held_(room.records_bytes) {}

void ReportCall::on_message(v1::ReportErosionRequest& message) {
  if (!header_) {
    if (!message.has_header()) refuse_without_header();
    begin(message.header());
    return;
  }
  if (refined_) {
    with_lease(room(), registry_, header_->token(), [&] {
      take(message);
      return false;
    });
    return;
  }
  if (!message.has_records()) refuse("only records may follow the header of a report");
  if (message.records().point_size() > wire::kRecordsPerMessage) {
    refuse("a message has at most 32768 records");
  }
  with_lease(room(), registry_, header_->token(), [&] {
    take(message.records());
    return false;
  });
}

void ReportCall::begin(const v1::ReportErosionHeader& header) {
  header_ = header;
  with_lease(room(), registry_, header.token(), [&] {
    const Store::BlockLease lease = store_.block_lease(header.token());
    job_ = lease.job;
    field_ = lease.field;
    worker_ = lease.worker;  // what the header calls it anybody could make up
    if (lease.kind == v1::TASK_KIND_REFINE) {
      refined_.emplace(lease.bounds);
    } else {
      batch_.emplace(lease.bounds.points, lease.directions, lease.bounds.volume, header.records());
    }
    return false;
  });
}

void ReportCall::take(const v1::FieldRecords& records) {
  const auto count = static_cast<std::uint64_t>(records.point_size());
  const std::uint64_t bytes = count * sizeof(wire::PointRecord);
  // Parts are as large as there is room for, over all reports: what finds none is not kept for the next message.
  bool has_room = !batch_->full() && held_.take(bytes);
  if (!has_room) {
    merge();
    has_room = held_.take(bytes);
  }
  batch_->append(records);
  received_ += count;
  if (!has_room) merge();
}

/// One message of a refinement: what it calls done is stored with it, not in parts.
void ReportCall::take(const v1::ReportErosionRequest& message) {
  if (!message.has_refined())
    refuse("only refined records may follow the header of a report on a refinement");
  const auto count = static_cast<std::uint64_t>(message.refined().point_size());
  if (count > wire::kRecordsPerMessage || received_ > 0)
    refuse("a report on a refinement has one message of at most 32768 records");
  if (!held_.take(count * sizeof(wire::RefinedPointRecord)))
    throw CallEnded({grpc::StatusCode::UNAVAILABLE, "reports take all the memory there is for them"});
  refined_->append(message.refined());
  received_ += count;
}

void ReportCall::merge() {
  if (!batch_->records().empty()) {
    batch_->sort();
    const bool merged = store_.report_part(header_->token(), *batch_);
    if (merged && !header_->bounds_for().empty()) {
      bounds_.pass_on(field_, worker_, batch_->records());
    }
  }
  batch_->clear();
  held_.give_back();
}

void ReportCall::on_end() {
  if (!header_) refuse_without_header();
  with_lease(room(), registry_, header_->token(), [&] { return finish(); });
}

bool ReportCall::finish() {
  // A stream that broke can look like one that ended; what it carried may be only half of a report.
  if (is_cancelled() || (header_->has_records() && header_->records() != received_)) {
    refuse("the report broke off: not all of its records arrived");
  }
  if (refined_) {
    response_ = store_.report_refined(*header_, *refined_);
    return response_.cancelled() || header_->block_done();
  }
  batch_->sort();
  Store::Reported reported = store_.report(*header_, *batch_);
  response_ = std::move(reported.response);
  if (!header_->bounds_for().empty()) {
    const std::uint32_t room = header_->bounds_bytes() == 0
                                   ? wire::kUsualBoundsBytes
                                   : std::min(header_->bounds_bytes(), wire::kMaxBoundsBytes);
    static const std::vector<wire::PointRecord> kNone;
    bounds_.exchange(field_, worker_, reported.merged ? batch_->records() : kNone, room, response_);
    if (header_->block_done() && store_.job(job_).stage() != v1::JOB_STAGE_ERODE) bounds_.forget(field_);
  }
  return response_.cancelled() || header_->block_done();
}

ResultCall::ResultCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store,
                       WorkerRegistry& registry, v1::ReportResponse& response)
    : Receiving(room, room.worker_calls, context, Method::kCompleteTask, room.results),
      store_(store),
      registry_(registry),
      response_(response) {}

void ResultCall::on_message(v1::CompleteTaskRequest& message) {
  if (header_) {
    registry_.used(header_->token());
    try {
      data_->add_message(message);
    } catch (const CallEnded&) {
      room().relieve_uploads();
      throw;
    }
    return;
  }
  if (!message.has_header()) refuse_without_header();
  header_ = message.header();
  if (header_->bytes() > wire::kMaxResultBytes) {
    refuse("a result has at most 2^31 - 1 bytes");  // the same one again would be as large
  }
  data_.emplace(room().upload_bytes, header_->bytes());
}

void ResultCall::on_end() {
  if (!header_) refuse_without_header();
  with_lease(room(), registry_, header_->token(), [&] {
    response_ = store_.complete(*header_, data_->data());
    return true;
  });
}

InputCall::InputCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store,
                     WorkerRegistry& registry, const v1::FetchInputRequest& request)
    : Sending(room, room.worker_inputs, context, Method::kFetchInput),
      store_(store),
      registry_(registry),
      request_(request) {}

StreamCall::After InputCall::open() {
  const std::weak_ptr<StreamCall> weak = weak_from_this();
  room().inputs.enter_later(caller(), weak, [this, weak](const grpc::Status& status, CallLimit::Place place) {
    const auto alive = weak.lock();
    if (alive == nullptr) return;
    const auto held = std::make_shared<CallLimit::Place>(std::move(place));
    run([this, status, held] {
      if (!status.ok()) throw CallEnded(status);
      return send_input(std::move(*held));
    });
  });
  return After::kWait;
}

StreamCall::After InputCall::send_input(CallLimit::Place place) {
  std::unique_ptr<BlobReader> reader;
  with_lease(room(), registry_, request_.token(), [&] {
    std::optional<std::int64_t> known;
    if (request_.has_known_round()) known = request_.known_round();
    reader = store_.open_input(request_.token(), request_.kind(), known);
    return false;
  });
  return send(std::move(place), std::move(reader), nullptr);
}

void InputCall::on_taken() {
  const auto now = std::chrono::steady_clock::now();
  if (now - renewed_ < std::chrono::milliseconds(store_.options().report_interval_ms)) return;
  renewed_ = now;
  with_lease(room(), registry_, request_.token(), [&] {
    store_.keep_lease(request_.token());
    return false;
  });
}

}  // namespace affskel::server
