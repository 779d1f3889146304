#pragma once

#include <prometheus/counter.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <chrono>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/mutex.h"

namespace affskel::server {

/// Owners that have a label of their own; all others share kOtherOwners, so that names do not fill the
/// memory of the collector.
inline constexpr std::size_t kMaxOwners = 100;
inline constexpr const char* kOtherOwners = "(others)";

/// The label of an owner: "(nobody)" for a caller without a name.  Names that begin with '(' get another one,
/// so that none looks like these two.
std::string owner_label(const std::string& owner);

/// What has happened since the server's start, counted for operators: metrics that only grow.  What is
/// measured stays where it happens and calls one of these functions.  Thread-safe; a call takes about a
/// microsecond.
class Metrics {
 public:
  using Duration = std::chrono::duration<double>;  ///< seconds

  Metrics();

  /// A call has ended, after so long.
  /// @param method as the contract has it. @param code of gRPC: "OK", "NOT_FOUND".
  void call_ended(const std::string& method, const std::string& code, Duration time);

  void job_submitted();
  /// @param state "done", "failed", "cancelled".
  void job_ended(const std::string& state);
  /// A job's stage took so long, pauses included.
  void stage_ended(const std::string& stage, Duration time);

  // Tasks: `kind` as in the contract, "erode".

  void lease_granted(const std::string& kind);
  /// It has expired, or its worker has ended.
  void lease_lost(const std::string& kind);
  /// A worker used a lease that had ended.
  void lease_fenced();
  /// Done, so long after it was leased.
  void task_finished(const std::string& kind, Duration time);

  /// Directions of an accepted report: done for the first time, and such as were done before.
  void directions(const std::string& owner, std::int64_t added, std::int64_t repeated);

  /// Sample points of an accepted report of a refinement, likewise; each counts once in every round.
  void refined_points(std::int64_t added, std::int64_t repeated);

  /// A transaction that writes waited for its turn and then worked, commit included.
  void transaction(Duration waited, Duration worked);

  /// All of it, for a serializer.
  std::vector<prometheus::MetricFamily> collect() const { return registry_.Collect(); }

 private:
  using Counters = prometheus::Family<prometheus::Counter>;
  using Histograms = prometheus::Family<prometheus::Histogram>;

  Counters& counters(const char* name, const char* help);
  Histograms& histograms(const char* name, const char* help);
  std::string known_owner(const std::string& owner);

  prometheus::Registry registry_;
  Counters& calls_;
  Histograms& call_times_;
  Counters& submitted_;
  Counters& ended_;
  Histograms& stage_times_;
  Counters& granted_;
  Counters& lost_;
  prometheus::Counter& fenced_;
  Histograms& task_times_;
  prometheus::Counter& directions_;
  prometheus::Counter& repeated_;
  Counters& owner_directions_;
  prometheus::Counter& refined_points_;
  prometheus::Counter& refined_points_repeated_;
  prometheus::Histogram& waited_;
  prometheus::Histogram& worked_;

  base::Mutex mutex_;
  std::set<std::string> owners_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server
