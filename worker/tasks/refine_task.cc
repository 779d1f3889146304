#include "tasks/refine_task.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/infimum/refinement.h"
#include "job/job_refinement.h"
#include "link/lease_keeper.h"
#include "wire/limits.h"

namespace affskel::worker {
namespace {

using Clock = std::chrono::steady_clock;

// Points that are computed between two looks at the clock: so many that the threads seldom wait for each other, few
// enough that a report is not late.
constexpr auto kShortBite = std::chrono::milliseconds(80), kLongBite = std::chrono::milliseconds(250);
constexpr std::uint32_t kFirstBite = 64, kMostBite = 8192;

void append(const core::RefinedPoint& found, const SolidUnits& units, v1::RefinedRecords& records) {
  const wire::RefinedRecord record = refined_record(found.least, units, 0);
  records.add_point(found.point);
  records.add_erosion(record.erosion);
  records.add_slope(record.slope);
  for (const double x : record.normal) records.add_normal(x);
  for (const std::uint32_t saddle : record.saddles) records.add_saddle(saddle);
}

class RefineTask {
 public:
  RefineTask(const v1::Lease& lease, PreparedJob& job, unsigned threads, ServerLink& link,
             TaskContext& context, LastReport& last, const std::function<void()>& nearly_done)
      : lease_(lease),
        job_(job),
        refinement_(job.refinement(threads)),
        link_(link),
        context_(context),
        last_(last),
        nearly_done_(nearly_done),
        interval_(lease.report_interval_ms()),
        bite_(kFirstBite * threads) {}

  void run() {
    catch_up();
    try {
      for (const v1::PositionRange& range : lease_.positions()) {
        compute({static_cast<std::uint32_t>(range.begin()), static_cast<std::uint32_t>(range.end())});
      }
    } catch (const core::CoreError&) {
      if (context_.why() != TaskContext::Why::kWorkerStops) throw;
      send();
      wait();
      throw;
    }
    wait();
    send_last();
  }

 private:
  // Hears of what it needs for the round.
  void catch_up() {
    if (lease_.round() == 0) {
      if (!refinement_.seeds().empty()) return;
      return refinement_.take_seeds(fetch(v1::ARTIFACT_KIND_FIELD));
    }
    const std::uint32_t before = lease_.round() - 1;
    if (refinement_.known() == before) return;
    refinement_.take_found(fetch(v1::ARTIFACT_KIND_REFINED), before);
  }

  std::string fetch(v1::ArtifactKind kind) {
    std::string bytes = link_.fetch(lease_.token(), kind, context_.token(), refinement_.known());
    core::throw_if_stopped(&context_);
    return bytes;
  }

  void compute(core::PointRange range) {
    for (std::uint32_t at = range.begin; at < range.end;) {
      const core::PointRange bite{at, std::min(range.end, at + std::min(bite_, kMostBite))};
      const bool last = bite.end == lease_.positions().rbegin()->end();
      std::future<void> ahead;
      if (last) ahead = std::async(std::launch::async, nearly_done_);
      const Clock::time_point begun = Clock::now();
      take(bite, find(bite));
      if (last) ahead.get();
      const Clock::duration time = Clock::now() - begun;
      if (time < kShortBite) bite_ = std::min(kMostBite, 2 * bite_);
      if (time > kLongBite) bite_ = std::max(1U, bite_ / 2);
      at = bite.end;
      const bool full = waiting_records_ + kMostBite > wire::kRecordsPerMessage;
      if (!last && (full || Clock::now() >= next_report_)) send();
    }
  }

  std::vector<core::RefinedPoint> find(core::PointRange range) {
    if (lease_.round() != 0)
      return refinement_.rounds().improve(static_cast<int>(lease_.round()), range, context_);
    return refinement_.rounds().descend(
        job_.directions(), [this](std::uint32_t point) { return refinement_.seeds()[point]; }, range,
        context_);
  }

  void take(core::PointRange range, const std::vector<core::RefinedPoint>& found) {
    if (!done_.empty() && done_.back().end() == range.begin) {
      done_.back().set_end(range.end);
    } else {
      v1::PositionRange& next = done_.emplace_back();
      next.set_begin(range.begin);
      next.set_end(range.end);
    }
    for (const core::RefinedPoint& point : found) append(point, refinement_.units(), records_);
    waiting_records_ += static_cast<int>(found.size());
  }

  // Sends what is done, once what was sent before is acknowledged.
  void send() {
    wait();
    next_report_ = Clock::now() + interval_;
    sent_ = std::async(std::launch::async, [this, report = take_report(false)] {
      return link_.report(report->header, report->messages);
    });
  }

  void send_last() {
    last_.start(lease_.token(), [&link = link_, lease = lease_, report = take_report(true)] {
      const LeaseKeeper still(link, lease);
      link.report(report->header, report->messages);
    });
  }

  struct Report {
    v1::ReportErosionHeader header;
    std::vector<v1::ReportErosionRequest> messages;
  };

  // Of what is done and was not sent.
  std::shared_ptr<const Report> take_report(bool block_done) {
    auto report = std::make_shared<Report>();
    v1::ReportErosionHeader& header = report->header;
    header.set_token(lease_.token());
    header.set_round(lease_.round());
    header.set_block_done(block_done);
    header.mutable_positions_done()->Assign(done_.begin(), done_.end());
    if (waiting_records_ > 0) report->messages.emplace_back().mutable_refined()->Swap(&records_);
    done_.clear();
    records_.Clear();
    waiting_records_ = 0;
    return report;
  }

  void wait() {
    if (!sent_.valid()) return;
    const v1::ReportResponse response = sent_.get();
    if (response.cancelled()) context_.stop(TaskContext::Why::kCancelled);
    if (response.report_interval_ms() != 0)
      interval_ = std::chrono::milliseconds(response.report_interval_ms());
  }

  const v1::Lease& lease_;
  PreparedJob& job_;
  JobRefinement& refinement_;
  ServerLink& link_;
  TaskContext& context_;
  LastReport& last_;
  const std::function<void()>& nearly_done_;
  std::chrono::milliseconds interval_;
  std::uint32_t bite_;
  Clock::time_point next_report_ = Clock::now() + interval_;
  std::vector<v1::PositionRange> done_;
  v1::RefinedRecords records_;
  int waiting_records_ = 0;
  std::future<v1::ReportResponse> sent_;  // last: its end waits for the call
};

}  // namespace

void refine(const v1::Lease& lease, PreparedJob& job, unsigned threads, ServerLink& link,
            TaskContext& context, LastReport& last, const std::function<void()>& nearly_done) {
  RefineTask(lease, job, threads, link, context, last, nearly_done).run();
}

}  // namespace affskel::worker
