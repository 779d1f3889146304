#include "store/time_left.h"

#include <algorithm>
#include <cmath>

namespace affskel::server {
namespace {

constexpr std::int64_t kSilenceMs = 30000;   // reports come every second or so
constexpr std::int64_t kForgetMs = 3600000;  // a job that no worker works on
constexpr double kGrain = 1.02;              // between marks, in directions done
constexpr double kMaxSpread = 3;
constexpr std::size_t kMinMarks = 6;
constexpr double kMinDone = 64;  // fewer are no measure of a rate, let alone of how it grows

}  // namespace

void TimeLeft::add(std::int64_t now_ms, std::uint64_t done, std::uint64_t total) {
  const bool known = !marks_.empty() && total_ == static_cast<double>(total);
  // Reports of several workers may come in another order than they were merged in.
  if (known && static_cast<double>(done) < marks_.back().done &&
      static_cast<double>(done) > 0.9 * marks_.back().done) {
    return;
  }
  const bool again = known && static_cast<double>(done) >= marks_.back().done;
  if (!again) marks_.clear();
  total_ = static_cast<double>(total);
  const std::int64_t passed = again ? now_ms - last_ms_ : 0;
  last_ms_ = now_ms;
  const Mark before = again ? marks_.back() : Mark{0, 0};
  const Mark mark{before.ms + static_cast<double>(passed > kSilenceMs ? 0 : passed),
                  static_cast<double>(done)};
  // The latest mark always counts; of the earlier ones those that are some way apart.
  if (marks_.size() > 1 && mark.done < kGrain * marks_[marks_.size() - 2].done) marks_.pop_back();
  marks_.push_back(mark);
}

double TimeLeft::ms_at(double done) const {
  const auto after = std::lower_bound(marks_.begin() + 1, marks_.end() - 1, done,
                                      [](const Mark& mark, double value) { return mark.done < value; });
  const Mark &a = after[-1], &b = *after;
  return b.done == a.done ? b.ms : a.ms + (b.ms - a.ms) * (done - a.done) / (b.done - a.done);
}

std::optional<double> TimeLeft::estimate() const {
  if (marks_.size() < kMinMarks) return std::nullopt;
  const auto [ms, done] = marks_.back();
  if (done < std::max(kMinDone, 4 * marks_.front().done)) return std::nullopt;
  const double half = ms - ms_at(done / 2), quarter = ms_at(done / 2) - ms_at(done / 4);
  if (half <= 0 || quarter <= 0) return std::nullopt;
  const double rate = done / 2 / half;
  const double growth = std::max(0.0, std::log2(2 * quarter / half));
  const double most = (total_ - done) / rate;
  const double middle = 0.75 * done;  // where the rate is that of the half
  const double least =
      std::abs(growth - 1) < 1e-9
          ? middle / rate * std::log(total_ / done)
          : middle / rate / (1 - growth) *
                (std::pow(total_ / middle, 1 - growth) - std::pow(done / middle, 1 - growth));
  if (!(most <= kMaxSpread * least)) return std::nullopt;
  return std::sqrt(most * least);
}

std::optional<std::uint64_t> TimeLeft::at(std::int64_t now_ms) const {
  if (now_ms - last_ms_ > kSilenceMs) return std::nullopt;
  const std::optional<double> left = estimate();
  if (!left || !(*left < 1e15)) return std::nullopt;
  return static_cast<std::uint64_t>(std::max(0.0, *left - static_cast<double>(now_ms - last_ms_)));
}

void TimesLeft::add(const std::string& job, std::int64_t now_ms, std::uint64_t done, std::uint64_t total) {
  const base::MutexLock lock(mutex_);
  if (done >= total) {
    jobs_.erase(job);
    return;
  }
  if (!jobs_.contains(job))
    std::erase_if(jobs_, [&](const auto& one) { return now_ms - one.second.last_ms() > kForgetMs; });
  jobs_[job].add(now_ms, done, total);
}

void TimesLeft::fill_in(v1::Job& job, std::int64_t now_ms) const {
  if (job.state() != v1::JOB_STATE_RUNNING ||
      !(job.stage() == v1::JOB_STAGE_ERODE || job.stage() == v1::JOB_STAGE_REFINE))
    return;
  const base::MutexLock lock(mutex_);
  const auto known = jobs_.find(job.id());
  if (known == jobs_.end()) return;
  if (const auto left = known->second.at(now_ms)) job.set_remaining_ms(*left);
}

}  // namespace affskel::server
