#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "base/mutex.h"

namespace affskel::server {

/// How long an erosion takes to its end, from the progress that its workers have reported.
///
/// The rate grows while an erosion goes on, as every direction tightens the bounds that spare the later ones
/// work, and the first report covers what is done once: nothing before it counts.  With d directions done, r1
/// is the rate over the later half of them and r0 that over the quarter before; both are known from four
/// times the first report on (and told from six reports and 64 directions on). Then the rest takes at most (K
/// - d) / r1, if the rate stays, and at least the integral of dp / r(p), if it goes on to grow by the factor
/// r1 / r0 with every doubling: r(p) = r1 (p / (3 d / 4))^a, a = log2(r1 / r0), from p = d to K. The estimate
/// is their geometric mean, and nothing as long as the one is more than three times the other: if the truth
/// lies between them, it lies within a factor sqrt(3) of what is told.
class TimeLeft {
 public:
  /// A report that came at `now_ms`, with `done` of `total` directions done in all.  A silence of more than
  /// 30 s, in which no worker worked, does not count.
  void add(std::int64_t now_ms, std::uint64_t done, std::uint64_t total);

  /// Milliseconds from `now_ms` on; nothing as long as they cannot be told.
  std::optional<std::uint64_t> at(std::int64_t now_ms) const;

  std::int64_t last_ms() const { return last_ms_; }

 private:
  struct Mark {
    double ms;  // of work, since the first report
    double done;
  };
  double ms_at(double done) const;
  std::optional<double> estimate() const;

  std::vector<Mark> marks_;  // ascending, a few hundred at most
  std::int64_t last_ms_ = 0;
  double total_ = 0;
};

/// The times left of all jobs that are being eroded or refined, each stage by itself; of a refinement what is done are
/// the points that have begun (base::refine_points_begun).  Forgotten by a restart.  Thread-safe.
class TimesLeft {
 public:
  void add(const std::string& job, std::int64_t now_ms, std::uint64_t done, std::uint64_t total);
  /// Sets `remaining_ms` of a job that runs, if it can be told.
  void fill_in(v1::Job& job, std::int64_t now_ms) const;

 private:
  mutable base::Mutex mutex_;
  std::map<std::string, TimeLeft> jobs_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server
