#include "metrics/metrics.h"

#include <google/protobuf/descriptor.h>
#include <prometheus/family.h>

#include "affskel/v1/client_service.pb.h"
#include "affskel/v1/types.pb.h"
#include "affskel/v1/worker_service.pb.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

// Upper ends in seconds.  Calls and transactions take milliseconds, or wait for a disk or a peer.
const prometheus::Histogram::BucketBoundaries kCallSeconds = {0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                                              0.1,    0.25,  0.5,    1,     2.5,  10,    30};

// Tasks and stages take from milliseconds to days.
const prometheus::Histogram::BucketBoundaries kTaskSeconds = {0.01, 0.1, 1, 10, 60, 600, 3600, 21600, 86400};

/// The methods of both services.
std::vector<std::string> methods() {
  std::vector<std::string> names;
  for (const auto* file : {v1::SubmitJobRequest::descriptor()->file(), v1::TaskKind_descriptor()->file()}) {
    const auto* service = file->service(0);
    for (int i = 0; i < service->method_count(); ++i) names.push_back(service->method(i)->name());
  }
  return names;
}

}  // namespace

std::string owner_label(const std::string& owner) {
  if (owner.empty()) return "(nobody)";
  return owner.front() == '(' ? "(" + owner : owner;
}

Metrics::Counters& Metrics::counters(const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry_);
}

Metrics::Histograms& Metrics::histograms(const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry_);
}

Metrics::Metrics()
    : calls_(counters("affskel_calls_total",
                      "Calls that have ended, by method and gRPC status code; the server itself calls "
                      "RenewLease every few "
                      "seconds, which is ABORTED, to see that it answers")),
      call_times_(
          histograms("affskel_call_duration_seconds",
                     "Time from the begin of a call to its end, by method; LeaseTask and WatchJob wait, and "
                     "streams take as long as their peer")),
      submitted_(counters("affskel_jobs_submitted_total", "Jobs submitted; the same job once more is none")),
      ended_(counters("affskel_jobs_ended_total", "Jobs that came to a final state, by state")),
      stage_times_(histograms("affskel_stage_duration_seconds",
                              "Time from the begin of a job's stage to its end, pauses included, by stage")),
      granted_(counters("affskel_leases_granted_total", "Leases granted, by kind of task")),
      lost_(
          counters("affskel_leases_expired_total",
                   "Leases that expired, made no progress or lost their worker's process, by kind of task")),
      fenced_(counters("affskel_leases_fenced_total",
                       "Calls of workers that were refused because their lease had ended")
                  .Add({})),
      task_times_(
          histograms("affskel_task_duration_seconds",
                     "Time from the lease under which a task was finished to its end, by kind of task")),
      directions_(counters("affskel_directions_total", "Directions done for the first time").Add({})),
      repeated_(
          counters("affskel_directions_repeated_total", "Directions reported that were done before").Add({})),
      owner_directions_(
          counters("affskel_owner_directions_total",
                   "Directions done for the first time, by the job's owner; the owners beyond the first "
                   "100 are counted together")),
      refined_points_(
          counters("affskel_refined_points_total", "Sample points refined, each counted in every round")
              .Add({})),
      refined_points_repeated_(counters("affskel_refined_points_repeated_total",
                                        "Sample points reported that were refined before, in the same round")
                                   .Add({})),
      waited_(histograms("affskel_transaction_wait_seconds",
                         "Time that writing transactions waited for their turn")
                  .Add({}, kCallSeconds)),
      worked_(
          histograms("affskel_transaction_duration_seconds",
                     "Time that writing transactions took from their turn on, commit to the disk included")
              .Add({}, kCallSeconds)) {
  // From 0 on: what appears with its first event shows no rate for it.
  submitted_.Add({});
  for (const std::string& method : methods()) {
    for (const char* fault : {"INTERNAL", "DATA_LOSS"}) calls_.Add({{"method", method}, {"code", fault}});
  }
  for (const std::string& kind : wire::words(*v1::TaskKind_descriptor())) {
    granted_.Add({{"kind", kind}});
    lost_.Add({{"kind", kind}});
  }
  for (const v1::JobState state : {v1::JOB_STATE_DONE, v1::JOB_STATE_FAILED, v1::JOB_STATE_CANCELLED})
    ended_.Add({{"state", wire::word(state)}});
}

void Metrics::call_ended(const std::string& method, const std::string& code, Duration time) {
  calls_.Add({{"method", method}, {"code", code}}).Increment();
  call_times_.Add({{"method", method}}, kCallSeconds).Observe(time.count());
}

void Metrics::job_submitted() {
  submitted_.Add({}).Increment();
}

void Metrics::job_ended(const std::string& state) {
  ended_.Add({{"state", state}}).Increment();
}

void Metrics::stage_ended(const std::string& stage, Duration time) {
  stage_times_.Add({{"stage", stage}}, kTaskSeconds).Observe(time.count());
}

void Metrics::lease_granted(const std::string& kind) {
  granted_.Add({{"kind", kind}}).Increment();
}

void Metrics::lease_lost(const std::string& kind) {
  lost_.Add({{"kind", kind}}).Increment();
}

void Metrics::lease_fenced() {
  fenced_.Increment();
}

void Metrics::task_finished(const std::string& kind, Duration time) {
  task_times_.Add({{"kind", kind}}, kTaskSeconds).Observe(time.count());
}

void Metrics::directions(const std::string& owner, std::int64_t added, std::int64_t repeated) {
  directions_.Increment(static_cast<double>(added));
  repeated_.Increment(static_cast<double>(repeated));
  owner_directions_.Add({{"owner", known_owner(owner)}}).Increment(static_cast<double>(added));
}

void Metrics::refined_points(std::int64_t added, std::int64_t repeated) {
  refined_points_.Increment(static_cast<double>(added));
  refined_points_repeated_.Increment(static_cast<double>(repeated));
}

void Metrics::transaction(Duration waited, Duration worked) {
  waited_.Observe(waited.count());
  worked_.Observe(worked.count());
}

std::string Metrics::known_owner(const std::string& owner) {
  const base::MutexLock lock(mutex_);
  if (owners_.contains(owner)) return owner_label(owner);
  if (owners_.size() >= kMaxOwners) return kOtherOwners;
  owners_.insert(owner);
  return owner_label(owner);
}

}  // namespace affskel::server
