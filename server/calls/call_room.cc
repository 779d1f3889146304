#include "calls/call_room.h"

#include <algorithm>
#include <optional>
#include <string>
#include <thread>

#include "calls/status.h"
#include "database/sqlite.h"

namespace affskel::server {
namespace {

CallLimitOptions places(const char* what, std::size_t most, std::optional<base::PaceOptions> pace = {}) {
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
  options.most = limits.connections;
  options.spare = std::min<std::size_t>(32, limits.connections / 16);
  options.for_workers = limits.connections / 8;
  return options;
}

AnswerOptions answers_of(const CallLimits& limits) {
  AnswerOptions options;
  options.pace = limits.sending;
  options.pace.first = options.pace.window;
  return options;
}

}  // namespace

CallRoom::CallRoom(const CallLimits& given, std::uint64_t most_upload_bytes)
    : limits(given),
      client_calls({.threads = std::clamp(std::thread::hardware_concurrency(), 2U, 8U)}),
      client_streams({.threads = 4}),
      worker_calls({.threads = 6}),
      worker_inputs({.threads = 2}),
      connections(connections_of(given)),
      answers(answers_of(given), [this](std::uint64_t number) { return connections.answered(number); }),
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
  answers.tick();
}

void CallRoom::tick_gate() {
  for (const std::int64_t token : gate->newly_invalid()) {
    const grpc::Status why{grpc::StatusCode::UNAUTHENTICATED, "the token has been revoked, or has expired"};
    for (CallLimit* limit : {&uploads, &downloads, &waiting, &watches, &reports, &results, &inputs, &polls}) {
      limit->end_of_token(token, why);
    }
  }
  gate->note_use();
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

namespace {

/// What gRPC knows of the caller.
Credentials credentials_of(const grpc::CallbackServerContext& context, const Caller& caller) {
  Credentials credentials;
  credentials.uid = caller.uid;
  const auto& metadata = context.client_metadata();
  if (const auto found = metadata.find("authorization"); found != metadata.end()) {
    credentials.authorization = std::string(found->second.data(), found->second.size());
    credentials.several_authorizations = metadata.count("authorization") > 1;
  }
  credentials.has_certificate = caller.has_certificate;
  return credentials;
}

/// The caller cannot be identified while the disk cannot be read: that says nothing about what the call is
/// for.
Admission admitted(Gate& gate, Method method, const Credentials& credentials) {
  try {
    return gate.admit(method, credentials);
  } catch (const OutOfFiles&) {
    throw;  // says what it is
  } catch (const SqliteError& error) {
    log_error(error);
    return {{grpc::StatusCode::UNAVAILABLE,
             "the server's disk cannot be read just now; its log says why, try again"},
            {}};
  }
}

}  // namespace

CallScope::CallScope(CallRoom& room, const grpc::CallbackServerContext& context, Method method)
    : call_(room.connections.begin(context.peer(), rule_of(method).side)) {
  const Admission admission = admitted(*room.gate, method, credentials_of(context, call_.caller()));
  if (!admission.status.ok()) throw CallEnded(admission.status);
  call_.identify(admission.identity);
  if (rule_of(method).side == Side::kClient) activity_ = std::make_unique<Activity::Call>(room.activity);
}

}  // namespace affskel::server
