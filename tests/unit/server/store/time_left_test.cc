#include "store/time_left.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/refine_rounds.h"
#include "store/recorded_progress.h"

namespace affskel::server {
namespace {

constexpr std::int64_t kBegin = 1'000'000;  // clocks do not begin at 0

struct Replay {
  std::size_t told = 0;       // estimates
  double worst = 1;           // factor between one of them and the truth, while there is a twentieth to come
  double share_at_first = 1;  // of the time, at the first estimate
  double longest_of_old_rule = 0;  // the first two reports' rate, kept up to the end, in times of the truth
};

Replay replay(std::span<const RecordedReport> reports) {
  Replay result;
  TimeLeft left;
  const auto [end_ms, total] = reports.back();
  for (const RecordedReport& report : reports.first(reports.size() - 1)) {
    left.add(kBegin + report.cpu_ms, report.done, total);
    const double truth = static_cast<double>(end_ms - report.cpu_ms);
    const auto told = left.at(kBegin + report.cpu_ms);
    if (!told || truth < 0.05 * static_cast<double>(end_ms)) continue;
    if (result.told++ == 0)
      result.share_at_first = static_cast<double>(report.cpu_ms) / static_cast<double>(end_ms);
    const double factor = static_cast<double>(*told) / truth;
    result.worst = std::max({result.worst, factor, 1 / factor});
  }
  const RecordedReport &a = reports[0], &b = reports[1];
  const double rate = static_cast<double>(b.done - a.done) / static_cast<double>(b.cpu_ms - a.cpu_ms);
  result.longest_of_old_rule =
      static_cast<double>(total - b.done) / rate / static_cast<double>(end_ms - b.cpu_ms);
  return result;
}

TEST(TimeLeft, OfRecordedJobsIsWithinAFactorOfTwoFromTheFirstOn) {
  for (const auto& reports : kRecordedJobs) {
    const Replay result = replay(reports);
    EXPECT_GE(result.told, 5u);
    EXPECT_LT(result.worst, 2) << reports.back().done << " directions";
    EXPECT_LT(result.share_at_first, 0.5) << reports.back().done << " directions";
  }
}

// Reports of every second of an erosion of three minutes whose rate grows as `rate` of the share done says.
std::vector<RecordedReport> made_up_reports(const std::function<double(double)>& rate) {
  constexpr int kTotal = 100000;
  constexpr double kEnd = 180000;
  std::vector<double> times = {0};  // at which so many directions are done
  for (int p = 0; p < kTotal; ++p) times.push_back(times.back() + 1 / rate((p + 0.5) / kTotal));
  const double scale = kEnd / times.back();
  std::vector<RecordedReport> reports;
  int done = 0;
  for (double ms = 1000; ms < kEnd; ms += 1000) {
    while (times[static_cast<std::size_t>(done) + 1] * scale <= ms) ++done;
    if (done > 0) reports.push_back({static_cast<std::int64_t>(ms), static_cast<std::uint64_t>(done)});
  }
  reports.push_back({static_cast<std::int64_t>(kEnd), kTotal});
  return reports;
}

TEST(TimeLeft, OfRatesThatGrowIsWithinAFactorOfTwoFromTheFirstOn) {
  for (const double power : {0.0, 0.25, 0.5, 0.75}) {
    const Replay result = replay(made_up_reports([&](double share) { return std::pow(share, power); }));
    EXPECT_GE(result.told, 5u) << power;
    EXPECT_LT(result.worst, 2) << power;
  }
}

// As when the first blocks find no bounds: 77 minutes were announced for three.
TEST(TimeLeft, IsNotToldFromAStartThatIsTwentySixTimesTooSlow) {
  const auto reports = made_up_reports([](double share) { return std::min(1.0, 1.0 / 26 + share / 0.02); });
  const Replay result = replay(reports);
  EXPECT_GT(result.longest_of_old_rule, 15);
  EXPECT_GE(result.told, 5u);
  EXPECT_LT(result.worst, 2);
  EXPECT_LT(result.share_at_first, 0.25);
}

TEST(TimeLeft, GoesDownBetweenReportsAndEndsWithTheWorkers) {
  TimeLeft left;
  for (int s = 1; s <= 50; ++s) left.add(kBegin + 1000 * s, static_cast<std::uint64_t>(10 * s), 1000);
  const std::int64_t now = kBegin + 50000;
  EXPECT_NEAR(static_cast<double>(left.at(now).value()), 50000, 500);
  EXPECT_EQ(left.at(now + 2000).value(), left.at(now).value() - 2000);
  EXPECT_FALSE(left.at(now + 31000));
}

TEST(TimeLeft, DoesNotCountSilence) {
  TimeLeft left;
  std::int64_t now = kBegin;
  for (std::uint64_t d = 10; d <= 500; d += 10) {
    now += d == 250 ? 3'600'000 : 1000;
    left.add(now, d, 1000);
  }
  EXPECT_NEAR(static_cast<double>(left.at(now).value()), 50000, 2000);
}

TEST(TimeLeft, TakesReportsOfTwoWorkersInAnyOrder) {
  TimeLeft left;
  for (int s = 1; s <= 50; ++s) {
    left.add(kBegin + 1000 * s, static_cast<std::uint64_t>(10 * s), 1000);
    left.add(kBegin + 1000 * s, static_cast<std::uint64_t>(10 * s - 1), 1000);
  }
  EXPECT_NEAR(static_cast<double>(left.at(kBegin + 50000).value()), 50000, 500);
}

TEST(TimeLeft, BeginsAnewWithWhatIsComputedAgain) {
  TimeLeft left;
  for (int s = 1; s <= 50; ++s) left.add(kBegin + 1000 * s, static_cast<std::uint64_t>(10 * s), 1000);
  left.add(kBegin + 51000, 10, 1000);
  EXPECT_FALSE(left.at(kBegin + 51000));
}

// A refinement on one worker: its first five rounds at one rate.
TEST(TimesLeft, AreToldOfRefinements) {
  constexpr std::int64_t kPoints = 80000;
  TimesLeft times;
  v1::Job job;
  job.set_id("a");
  job.set_state(v1::JOB_STATE_RUNNING);
  job.set_stage(v1::JOB_STAGE_REFINE);
  std::int64_t second = 0;
  constexpr std::array<std::int64_t, 6> kSteps = {10, 30, 30, 10, 40, 1};
  for (std::int64_t round = 0; round < 6; ++round) {
    const std::int64_t steps = kSteps[static_cast<std::size_t>(round)];
    for (std::int64_t n = 1; n <= steps; ++n) {
      const std::int64_t begun = base::refine_points_begun(round, kPoints * n / steps, kPoints);
      times.add("a", kBegin + 1000 * ++second, static_cast<std::uint64_t>(begun), kPoints);
      job.clear_remaining_ms();
      times.fill_in(job, kBegin + 1000 * second);
      if (round == 2) {
        EXPECT_NEAR(static_cast<double>(job.remaining_ms()), 1000. * static_cast<double>(120 - second), 2000);
      }
    }
  }
  EXPECT_FALSE(job.has_remaining_ms()) << "all is done";
}

TEST(TimesLeft, AreToldOfJobsThatRun) {
  TimesLeft times;
  for (int s = 1; s <= 50; ++s) times.add("a", kBegin + 1000 * s, static_cast<std::uint64_t>(10 * s), 1000);
  v1::Job job;
  job.set_id("a");
  job.set_state(v1::JOB_STATE_RUNNING);
  job.set_stage(v1::JOB_STAGE_ERODE);
  times.fill_in(job, kBegin + 50000);
  EXPECT_TRUE(job.has_remaining_ms());
  v1::Job queued = job;
  queued.clear_remaining_ms();
  queued.set_state(v1::JOB_STATE_QUEUED);
  times.fill_in(queued, kBegin + 50000);
  EXPECT_FALSE(queued.has_remaining_ms());
  times.add("a", kBegin + 51000, 1000, 1000);
  job.clear_remaining_ms();
  times.fill_in(job, kBegin + 51000);
  EXPECT_FALSE(job.has_remaining_ms()) << "all directions are done";
}

}  // namespace
}  // namespace affskel::server
