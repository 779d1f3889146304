#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "affskel/v1/worker_service.pb.h"
#include "calls/receiving.h"
#include "calls/status.h"
#include "calls/upload.h"
#include "scheduling/bounds_exchange.h"
#include "scheduling/worker_registry.h"
#include "services/sending.h"
#include "services/watchdog.h"
#include "store/store.h"

namespace affskel::server {

/// Runs a body that uses a lease, and tells the registry and the metrics.  The body returns whether the lease
/// has ended by it; a fenced one has.
template <typename Body>
void with_lease(CallRoom& room, WorkerRegistry& registry, const std::string& token, Body&& body) {
  registry.used(token);
  bool ended = false;
  const grpc::Status status = guarded([&] { ended = body(); });
  const bool fenced = status.error_code() == grpc::StatusCode::ABORTED;
  if (ended || fenced) registry.ended(token);
  if (fenced && token != kWatchdogToken) room.metrics.lease_fenced();
  if (!status.ok()) throw CallEnded(status);
}

/// ReportErosion: a header, then any number of records.  They are merged in parts as they arrive; only the
/// end of the report calls positions done.
class ReportCall final : public Receiving<v1::ReportErosionRequest> {
 public:
  ReportCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, WorkerRegistry& registry,
             BoundsExchange& bounds, v1::ReportResponse& response);

 private:
  void on_message(v1::ReportErosionRequest& message) override;
  void on_end() override;
  void begin(const v1::ReportErosionHeader& header);
  void take(const v1::FieldRecords& records);
  void take(const v1::ReportErosionRequest& message);
  void merge();
  bool finish();

  Store& store_;
  WorkerRegistry& registry_;
  BoundsExchange& bounds_;
  v1::ReportResponse& response_;
  UploadBudget::Share held_;
  std::optional<v1::ReportErosionHeader> header_;
  std::string job_;
  std::string field_, worker_;
  std::optional<RecordBatch> batch_;     // of ERODE
  std::optional<RefinedBatch> refined_;  // of REFINE
  std::uint64_t received_ = 0;           // records
};

/// CompleteTask: a header, then the result.
class ResultCall final : public Receiving<v1::CompleteTaskRequest> {
 public:
  ResultCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, WorkerRegistry& registry,
             v1::ReportResponse& response);

 private:
  void on_message(v1::CompleteTaskRequest& message) override;
  void on_end() override;

  Store& store_;
  WorkerRegistry& registry_;
  v1::ReportResponse& response_;
  std::optional<v1::CompleteTaskHeader> header_;
  std::optional<Upload> data_;
};

/// FetchInput: sends an input of a leased task, and keeps the lease as long as the worker takes it: over a slow line its
/// own renewals wait behind the input.
class InputCall final : public Sending {
 public:
  InputCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, WorkerRegistry& registry,
            const v1::FetchInputRequest& request);

 private:
  After open() override;
  After send_input(CallLimit::Place place);
  void on_taken() override;

  Store& store_;
  WorkerRegistry& registry_;
  const v1::FetchInputRequest request_;
  std::chrono::steady_clock::time_point renewed_ = std::chrono::steady_clock::now();
};

}  // namespace affskel::server
