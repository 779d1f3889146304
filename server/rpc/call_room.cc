#include "rpc/call_room.h"

#include <algorithm>
#include <optional>

namespace affskel::server {
namespace {

// Looking through thousands of descriptors takes a few milliseconds.
constexpr unsigned kTicksPerSweep = 5;

CallLimitOptions places(const char* what, std::size_t most, std::optional<PaceOptions> pace = {}) {
  CallLimitOptions options;
  options.what = what;
  options.most = most;
  options.pace = pace;
  return options;
}

CallLimitOptions downloads_of(const CallLimits& limits) {
  CallLimitOptions options = places("downloads", limits.downloads, limits.sending);
  options.patience = limits.patience;
  return options;
}

CallLimitOptions inputs_of(const CallLimits& limits) {
  CallLimitOptions options = places("inputs of tasks", limits.inputs, limits.sending);
  options.patience = limits.patience;
  return options;
}

CallLimitOptions waiting_of(const CallLimits& limits) {
  CallLimitOptions options = places("requests for artefacts that are yet to be made", limits.waiting);
  options.half_for_a_peer = true;
  options.refusal = grpc::StatusCode::RESOURCE_EXHAUSTED;
  return options;
}

ConnectionOptions connections_of(const CallLimits& limits) {
  ConnectionOptions options;
  options.first_refused = limits.connections;
  options.most = static_cast<std::size_t>(limits.connections);
  options.spare = std::min(32, limits.connections / 16);
  options.for_workers = static_cast<std::size_t>(limits.connections / 8);
  return options;
}

}  // namespace

CallRoom::CallRoom(const CallLimits& given, std::uint64_t most_upload_bytes)
    : limits(given),
      client_calls({.threads = 4}),
      client_streams({.threads = 4}),
      worker_calls({.threads = 6}),
      worker_inputs({.threads = 2}),
      connections(connections_of(given)),
      upload_bytes(most_upload_bytes),
      records_bytes(given.records_bytes),
      uploads(places("uploads", given.uploads, given.receiving)),
      downloads(downloads_of(given)),
      waiting(waiting_of(given)),
      watches(places("watches", given.watches)),
      reports(places("reports", given.reports, given.receiving)),
      results(places("results of tasks", given.results, given.receiving)),
      inputs(inputs_of(given)),
      polls(places("workers that wait for work", given.polls)) {}

void CallRoom::tick() {
  for (CallLimit* limit : {&uploads, &downloads, &reports, &results, &inputs}) limit->tick();
  if (++ticks_ % kTicksPerSweep == 0) connections.sweep();
}

void CallRoom::relieve_uploads() {
  if (!uploads.relieve()) results.relieve();
}

void CallRoom::close() {
  const grpc::Status why = shutting_down();
  for (CallLimit* limit : {&uploads, &downloads, &waiting, &watches, &polls}) limit->close(why);
  for (CallLimit* limit : {&waiting, &watches, &polls}) limit->end_all(why);
}

void CallRoom::stop() {
  for (Executor* executor : {&client_calls, &client_streams, &worker_calls, &worker_inputs}) executor->stop();
}

}  // namespace affskel::server
