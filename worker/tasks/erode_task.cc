#include "tasks/erode_task.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <thread>
#include <vector>

#include "base/mutex.h"
#include "link/lease_keeper.h"
#include "wire/direction_order.h"
#include "wire/erosion_bound.h"
#include "wire/limits.h"

namespace affskel::worker {
namespace {

// Shared by the computing threads and the reporting one.
class Progress : public core::ExecutionContext {
 public:
  explicit Progress(const v1::Lease& lease) {
    const std::uint64_t count = lease.job().directions_total();
    for (const v1::PositionRange& range : lease.positions()) {
      for (std::uint64_t p = range.begin(); p < range.end(); ++p) {
        positions_.push_back(p);
        directions_.push_back(
            static_cast<std::uint32_t>(wire::direction_at(p, lease.job().order_stride(), count)));
      }
    }
  }

  const std::vector<std::uint32_t>& directions() const { return directions_; }

  bool stop_requested() override { return stop_; }
  void stop() { stop_ = true; }

  void item_done(std::uint64_t item) override {
    const base::MutexLock guard(mutex_);
    done_.push_back(positions_[item]);
    ++done_in_all_;
    if (!nearly_done_ && time_left() < kAhead) {
      nearly_done_ = true;
      changed_.notify_all();
    }
  }

  void finish() {
    {
      const base::MutexLock guard(mutex_);
      finished_ = true;
    }
    changed_.notify_all();
  }

  enum class Event { kTime, kNearlyDone, kEnd };

  // Waits for the computation to end, to come near its end (told once), or the time to pass.
  Event wait_for_event(std::chrono::steady_clock::time_point until, const std::stop_token& stop) {
    base::MutexLock lock(mutex_);
    const auto something = [this] {
      mutex_.assert_held();
      return finished_ || (nearly_done_ && !nearly_done_told_);
    };
    changed_.wait_until(lock, stop, until, something);
    if (finished_) return Event::kEnd;
    if (!nearly_done_ || nearly_done_told_) return Event::kTime;
    nearly_done_told_ = true;
    return Event::kNearlyDone;
  }

  void wait_for_end() {
    base::MutexLock lock(mutex_);
    changed_.wait(lock, [this] {
      mutex_.assert_held();
      return finished_;
    });
  }

  // Moves what was finished since the last call into the header, as ranges.
  void take_done(v1::ReportErosionHeader& header) {
    std::vector<std::uint64_t> done;
    {
      const base::MutexLock guard(mutex_);
      done.swap(done_);
      header.set_block_done(finished_ && done_in_all_ == positions_.size());
    }
    std::sort(done.begin(), done.end());
    for (std::uint64_t p : done) {
      const int last = header.positions_done_size() - 1;
      if (last >= 0 && header.positions_done(last).end() == p) {
        header.mutable_positions_done(last)->set_end(p + 1);
      } else {
        v1::PositionRange* range = header.add_positions_done();
        range->set_begin(p);
        range->set_end(p + 1);
      }
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  // Must be longer than leasing a block takes while the server stores a large report, but short: a block that
  // waits here for its turn is one that another worker might lack.
  static constexpr auto kAhead = std::chrono::milliseconds(150);

  // For what is not done, at the speed so far.
  Clock::duration time_left() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    const auto left = static_cast<double>(positions_.size() - done_in_all_);
    return std::chrono::duration_cast<Clock::duration>((Clock::now() - start_) *
                                                       (left / static_cast<double>(done_in_all_)));
  }

  const Clock::time_point start_ = Clock::now();
  std::vector<std::uint64_t> positions_;
  std::vector<std::uint32_t> directions_;
  std::atomic<bool> stop_{false};
  base::Mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<std::uint64_t> done_ ABSL_GUARDED_BY(mutex_);
  std::uint64_t done_in_all_ ABSL_GUARDED_BY(mutex_) = 0;
  bool nearly_done_ ABSL_GUARDED_BY(mutex_) = false;
  bool nearly_done_told_ ABSL_GUARDED_BY(mutex_) = false;
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;
};

// Of a report that is made at once: what the server holds before it merges.
constexpr std::uint32_t kRecordsPerReport = 4 * wire::kRecordsPerMessage;

// What improved in a part of the field since the last call, in messages of the size that the wire takes.
std::vector<v1::ReportErosionRequest> take_records(const PreparedJob& job, core::ErosionField& field,
                                                   std::size_t part, std::size_t parts) {
  std::vector<v1::ReportErosionRequest> messages;
  v1::FieldRecords* records = nullptr;
  const auto take = [&](std::uint32_t point, const core::FieldValue& value) {
    if (records == nullptr || records->point_size() == wire::kRecordsPerMessage) {
      records = messages.emplace_back().mutable_records();
    }
    records->add_point(point);
    const wire::FieldRecord record = job.record(value);
    records->add_direction(record.direction);
    records->add_erosion(record.erosion);
    records->add_area(record.area);
  };
  field.take_changes(take, part, parts);
  return messages;
}

// Applies the bounds that other workers found: chords above them need not be computed.
void take_bounds(const v1::ReportResponse& response, const PreparedJob& job, core::ErosionField& field) {
  for (const v1::ErosionBounds& bounds : response.bounds()) {
    std::uint64_t point = 0;
    for (int i = 0; i < std::min(bounds.step_size(), bounds.bound_size()); ++i) {
      point += bounds.step(i);
      const double bound = wire::bound_value(bounds.bound(i)) / job.volume_unit();
      // A subnormal bound may have been rounded down.
      if (point < field.size() && std::isnormal(bound)) field.bound(static_cast<std::uint32_t>(point), bound);
    }
  }
}

// A report that is large is made in parts, of which the last calls the positions done: what other workers found
// meanwhile comes with the answer to each, and need not be reported in the next.  So workers begin at different places.
v1::ReportResponse report(const v1::ReportErosionHeader& header, const PreparedJob& job,
                          core::Erosion& erosion, ServerLink& link) {
  core::ErosionField& field = erosion.field();
  const std::size_t parts = 1 + field.changes() / kRecordsPerReport;
  const std::size_t first = std::hash<std::string>()(header.token()) % parts;
  v1::ReportErosionHeader of_part;
  of_part.set_token(header.token());
  v1::ReportResponse response;
  for (std::size_t i = 1; i <= parts && !response.cancelled(); ++i) {
    response =
        link.report(i == parts ? header : of_part, take_records(job, field, (first + i) % parts, parts));
    take_bounds(response, job, field);
  }
  return response;
}

}  // namespace

ErodeEnd erode(const v1::Lease& lease, PreparedJob& job, core::Erosion& erosion, ServerLink& link,
               std::stop_token stop, LastReport& last, const std::function<void()>& nearly_done) {
  // Reports renew the lease, but one of them, or the one that `last` holds, may take longer than that.
  const LeaseKeeper keeper(link, lease);
  Progress progress(lease);
  if (stop.stop_requested()) progress.stop();
  std::exception_ptr error;
  std::jthread computing([&] {
    try {
      erosion.run(progress.directions(), progress);
    } catch (...) {
      error = std::current_exception();
    }
    progress.finish();
  });
  // Whatever ends this function, the computation ends first.
  struct Joiner {
    Progress& progress;
    ~Joiner() { progress.stop(); }
  } joiner{progress};

  std::chrono::milliseconds interval(lease.report_interval_ms());
  auto next_report = std::chrono::steady_clock::now() + interval;
  for (;;) {
    const Progress::Event event = progress.wait_for_event(next_report, stop);
    bool ended = event == Progress::Event::kEnd;
    if (!ended && stop.stop_requested()) {
      progress.stop();
      progress.wait_for_end();
      ended = true;
    } else if (event == Progress::Event::kNearlyDone) {
      nearly_done();
      continue;
    }
    if (ended) computing.join();
    if (ended && error) std::rethrow_exception(error);
    v1::ReportErosionHeader header;
    header.set_token(lease.token());
    progress.take_done(header);
    if (header.block_done()) {
      last.start(lease.token(), [&job, &erosion, &link, lease, header] {
        const LeaseKeeper still(link, lease);
        report(header, job, erosion, link);
      });
      return ErodeEnd::kBlockDone;
    }
    last.wait();
    const v1::ReportResponse response = report(header, job, erosion, link);
    if (response.cancelled()) return ErodeEnd::kCancelled;
    if (ended) return ErodeEnd::kStopped;
    if (response.report_interval_ms() != 0)
      interval = std::chrono::milliseconds(response.report_interval_ms());
    next_report = std::chrono::steady_clock::now() + interval;
  }
}

}  // namespace affskel::worker
