#include "client/text/job_text.h"

#include <gtest/gtest.h>

#include <sstream>

#include "base/number_text.h"
#include "client/cli/global_options.h"
#include "client/cli/progress.h"
#include "client/cli/shell_words.h"
#include "client/text/key_line.h"
#include "client/text/message_json.h"
#include "client/text/nearest_word.h"
#include "client/text/server_text.h"
#include "client/text/shell_quoted.h"
#include "client/text/summary_text.h"
#include "client/text/time_text.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

using std::chrono::milliseconds;

TEST(JobJson, UsesWordsNumbersAndNull) {
  v1::Job job;
  job.set_state(v1::JOB_STATE_QUEUED);
  job.mutable_params()->mutable_sampling()->set_target_points(std::uint64_t{1} << 62);
  job.mutable_skeleton()->set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  job.add_done_positions()->set_end(7);
  const nlohmann::ordered_json json = to_json(job);
  EXPECT_EQ(json["state"], "queued");
  EXPECT_TRUE(json["stage"].is_null());
  EXPECT_EQ(json["skeleton"]["operator"], "zucker-hummel");
  EXPECT_EQ(json["params"]["sampling"]["target_points"], std::uint64_t{1} << 62);
  EXPECT_FALSE(json["params"]["sampling"].contains("spacing")) << "the other member of the oneof";
  EXPECT_EQ(json["done_positions"][0]["end"], 7);
  EXPECT_EQ(json["cancel_requested"], false);
  EXPECT_FALSE(json.contains("prepared"));
  EXPECT_EQ(json.begin().key(), "id") << "in the protocol's order";
}

TEST(StateWords, AreTheContractsWords) {
  EXPECT_EQ(state_word(v1::JOB_STATE_DONE), "done");
  EXPECT_EQ(state_word(v1::JOB_STATE_CANCELLED), "cancelled");
  EXPECT_EQ(stage_word(v1::JOB_STAGE_PREPARE), "prepare");
  EXPECT_EQ(state_word(static_cast<v1::JobState>(99)), "unknown");
}

TEST(UtcTime, IsReadable) {
  EXPECT_EQ(utc_time(0), "-");
  EXPECT_EQ(utc_time(1706702096789), "2024-01-31 11:54:56.789Z");
}

TEST(DurationText, PicksItsUnits) {
  EXPECT_EQ(duration_text(milliseconds(-5)), "0.0 s");
  EXPECT_EQ(duration_text(milliseconds(3456)), "3.4 s");
  EXPECT_EQ(duration_text(milliseconds(59999)), "59 s");
  EXPECT_EQ(duration_text(milliseconds(185000)), "3 min 05 s");
  EXPECT_EQ(duration_text(milliseconds(7620000)), "2 h 07 min");
  EXPECT_EQ(duration_text(std::chrono::hours(123)), "5 d 03 h");
}

TEST(TookText, HasTheMillisecondsThatWereMeasured) {
  EXPECT_EQ(took_text(milliseconds(34)), "0.034 s");
  EXPECT_EQ(took_text(milliseconds(59999)), "59.999 s");
  EXPECT_EQ(took_text(milliseconds(185000)), "3 min 05 s");
}

TEST(Plain, HasNoExponentAndNoMoreDigitsThanAreKnown) {
  EXPECT_EQ(base::plain(8e9, 12), "8000000000");
  EXPECT_EQ(base::plain(4188790204.7863907, 12), "4188790204.79");
  EXPECT_EQ(base::plain(0.1 + 0.2, 12), "0.3");
  EXPECT_EQ(base::plain(123456, 3), "123000");
  EXPECT_EQ(base::plain(-2.5e-5, 12), "-0.000025");
  EXPECT_EQ(base::plain(1e18, 12), "1e+18");
  EXPECT_EQ(base::plain(1e-9, 12), "1e-09");
  EXPECT_EQ(base::plain(0, 12), "0");
}

TEST(NearestWord, FindsWhatWasMeant) {
  const std::vector<std::string> known = {"--spacing", "--points", "--priority",
                                          "-o",        "--output", "--directions"};
  EXPECT_EQ(nearest_word("--spcing", known), "--spacing");
  EXPECT_EQ(nearest_word("--piority", known), "--priority");
  EXPECT_EQ(nearest_word("--ouptut", known), "--output");
  EXPECT_EQ(nearest_word("--dir", known), "--directions") << "it begins so";
  EXPECT_EQ(nearest_word("--banana", known), "");
  EXPECT_EQ(nearest_word("-x", known), "") << "one letter is near to all others";
}

TEST(ShellQuoted, ReadsBackInAShell) {
  EXPECT_EQ(shell_quoted("unix:/run/a.sock"), "unix:/run/a.sock");
  EXPECT_EQ(shell_quoted("my scan"), "'my scan'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted(""), "''");
  for (const std::string word : {"a b", "it's", "$HOME", "x;y", "tab\there", "\\"})
    EXPECT_EQ(shell_words("c " + shell_quoted(word)), (std::vector<std::string>{"c", word}));
}

TEST(ShellWords, TakesALineThatIsBeingTyped) {
  EXPECT_EQ(shell_words("a  b\\ c 'd e"), (std::vector<std::string>{"a", "b c", "d e"}));
  EXPECT_EQ(shell_words("a \"b 'c\" ''"), (std::vector<std::string>{"a", "b 'c", ""}));
  EXPECT_TRUE(shell_words("  ").empty());
}

TEST(NextCommand, RepeatsWhatReachesTheServer) {
  GlobalOptions options;
  EXPECT_EQ(next_command(options, "list"), "affskel-client list");
  options.server = "lab:7060";
  options.access.token_file = "my token";
  options.access.tls_ca = "ca.pem";
  options.json = options.quiet = true;
  EXPECT_EQ(next_command(options, "list"),
            "affskel-client --server lab:7060 --token-file 'my token' --tls-ca ca.pem list");
}

TEST(FileStem, IsAName) {
  EXPECT_EQ(file_stem("body"), "body");
  EXPECT_EQ(file_stem("a/b\n"), "a_b_");
  EXPECT_EQ(file_stem("-o"), "./-o");
  EXPECT_EQ(file_stem(""), "skeleton");
}

TEST(JobTable, AlignsAndCannotBreakTheTerminal) {
  v1::Job job;
  job.set_id("0123456789abcdef0123456789abcdef");
  job.set_name("evil\n\x1b[2J");
  job.set_state(v1::JOB_STATE_RUNNING);
  job.set_stage(v1::JOB_STAGE_ERODE);
  job.set_directions_done(3);
  job.set_directions_total(500);
  job.set_created_ms(1000);
  const std::string table = job_table({job}, 6000);
  EXPECT_EQ(table,
            "JOB           STATE    STAGE  DIRECTIONS  POINTS  SKELETON  AGE    OWNER  NAME\n"
            "0123456789ab  running  erode  3/500       -       -         5.0 s         evil ?[2J\n");
}

TEST(JobTable, FitsANarrowTerminal) {
  v1::Job job;
  job.set_id("0123456789abcdef0123456789abcdef");
  job.set_name("a rather long name of a body");
  job.set_state(v1::JOB_STATE_RUNNING);
  job.set_stage(v1::JOB_STAGE_ERODE);
  job.set_created_ms(1000);
  for (const unsigned width : {40u, 60u, 80u, 120u}) {
    const std::string table = job_table({job}, 6000, false, width);
    for (std::size_t begin = 0, end = 0; (end = table.find('\n', begin)) != std::string::npos;
         begin = end + 1)
      EXPECT_LE(end - begin, width) << table;
    EXPECT_NE(table.find("0123456789ab  running  "), std::string::npos) << table;
  }
  EXPECT_EQ(job_table({job}, 6000, false, 40),
            "JOB           STATE    NAME\n"
            "0123456789ab  running  a rather long nam\n");
  EXPECT_EQ(job_table({job}, 6000, false, 120), job_table({job}, 6000));
}

TEST(JobDetails, TellsWhyAJobFailedOrWaits) {
  v1::Job job;
  job.set_state(v1::JOB_STATE_FAILED);
  job.mutable_error()->set_code("BAD_INPUT");
  job.mutable_error()->set_message("hole");
  job.mutable_error()->set_line(12);
  EXPECT_NE(job_details(job).find("reason:               BAD_INPUT: hole (line 12 of the submitted file)\n"),
            std::string::npos);
  job.Clear();
  job.set_state(v1::JOB_STATE_QUEUED);
  job.set_waiting_reason("no workers");
  EXPECT_NE(job_details(job).find("reason:               no workers\n"), std::string::npos);
}

TEST(JobDetails, TellsWarningsOfARepairAsWarnings) {
  v1::Job job;
  for (const char* severity : {"repaired", "warning", ""}) {
    v1::RepairStep& step = *job.mutable_repair()->add_steps();
    step.set_code("step");
    step.set_message("done " + std::to_string(job.repair().steps_size()));
    step.set_severity(severity);
  }
  const std::string text = job_details(job, false);
  const std::string told = key_line("repaired", "step: done 1") + key_line("warning", "step: done 2") +
                           key_line("repaired", "step: done 3");
  EXPECT_NE(text.find(told), std::string::npos) << text;
  EXPECT_NE(job_details(job, true).find("\033[33mwarning: "), std::string::npos);
  const Notices warnings = job_warnings(job);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].message, "done 2");
}

TEST(JobDetails, TellsHowLongAJobIsKept) {
  constexpr std::uint64_t kTime = 1'700'000'000'000;
  v1::Job job;
  job.set_state(v1::JOB_STATE_DONE);
  EXPECT_EQ(job_details(job).find("expires"), std::string::npos);
  job.set_expires_ms(kTime);
  EXPECT_NE(job_details(job).find(utc_time(kTime) + ", with its mesh; pin keeps it\n"), std::string::npos)
      << "it has no results";
  job.mutable_prepared();
  EXPECT_NE(job_details(job).find(utc_time(kTime) + ", its results; pin keeps it\n"), std::string::npos);
  job.set_removed_ms(kTime - 1000);
  EXPECT_NE(job_details(job).find(utc_time(kTime) + ", with its mesh; pin keeps it\n"), std::string::npos);
  EXPECT_NE(job_details(job).find(utc_time(kTime - 1000) +
                                  ", by the server's retention; resume computes them again\n"),
            std::string::npos);
  job.set_directions_total(500);
  EXPECT_NE(job_details(job).find("directions:           removed\n"), std::string::npos) << job_details(job);
  job.set_pinned(true);
  EXPECT_NE(job_details(job).find("pinned:               yes\n"), std::string::npos);
}

TEST(JobDetails, ShowsTheFrameUnlessItIsTheMeshs) {
  v1::Job job;
  for (const double v : {1, 0, 0, 0, 1, 0, 0, 0, 1}) job.mutable_prepared()->add_frame(v);
  for (const v1::Frame own : {v1::FRAME_UNSPECIFIED, v1::FRAME_AXIS}) {
    job.mutable_params()->set_frame(own);
    EXPECT_EQ(job_details(job).find("frame"), std::string::npos);
  }
  job.mutable_params()->set_frame(v1::FRAME_AFFINE);
  job.mutable_prepared()->clear_frame();
  for (const double v : {2.0, 0.0, 0.25, 0.0, 1.0, 0.0, -1.0, 0.0, 0.5}) job.mutable_prepared()->add_frame(v);
  const std::string text = job_details(job);
  EXPECT_NE(text.find("asked_frame:          affine\n"), std::string::npos) << text;
  EXPECT_NE(text.find("frame_vectors:        2 0 0.25, 0 1 0, -1 0 0.5\n"), std::string::npos) << text;
  const nlohmann::ordered_json json = to_json(job);
  EXPECT_EQ(json["params"]["frame"], "affine");
  EXPECT_EQ(json["prepared"]["frame"].size(), 9U);
}

v1::Job eroding(std::uint64_t done) {
  v1::Job job;
  job.set_state(v1::JOB_STATE_RUNNING);
  job.set_stage(v1::JOB_STAGE_ERODE);
  job.set_directions_done(done);
  job.set_directions_total(400);
  return job;
}

TEST(ProgressBar, ShowsTheShareAndFits) {
  v1::Job job = eroding(100);
  job.set_remaining_ms(2500);
  EXPECT_EQ(progress_bar(job, 123.4, 90),
            "erode     [######....................]  25.0% 100/400 directions    123/s 2.5 s left      ");
  for (int width = 0; width < 100; ++width) {
    EXPECT_LE(progress_bar(job, 123.4, width).size(), std::size_t(width)) << width;
  }
}

// A part of a number would be another one.
TEST(ProgressBar, LeavesOutWholeFields) {
  v1::Job job = eroding(100);
  job.set_remaining_ms(7620000);
  job.set_waiting_reason("the disk is full");
  const std::string whole =
      "erode      25.0% 100/400 directions   4642/s 2 h 07 min left  (the disk is full)";
  for (int width = 9; width < 90; ++width) {
    std::string line = progress_bar(job, 4642, width);
    line.erase(line.find_last_not_of(' ') + 1);
    ASSERT_TRUE(whole.starts_with(line)) << line;
    if (line.size() == whole.size()) continue;
    EXPECT_EQ(whole[line.size()], ' ') << line;
    for (const char* part : {" 2", " h", " 07", " min"}) EXPECT_FALSE(line.ends_with(part)) << line;
  }
  EXPECT_EQ(progress_bar(job, 4642, 42), "erode      25.0% 100/400 directions");
}

TEST(ProgressBar, KeepsItsWidth) {
  const std::size_t width = progress_bar(eroding(0), 0, 100).size();
  for (const std::uint64_t done : {1u, 99u, 399u, 400u}) {
    for (const std::uint64_t ms : {0ull, 9900ull, 3599000ull, 86399000ull, 86400000ull * 99}) {
      for (const double rate : {0.0, 0.012, 3.4, 99999.0}) {
        v1::Job job = eroding(done);
        if (ms > 0) job.set_remaining_ms(ms);
        EXPECT_EQ(progress_bar(job, rate, 100).size(), width) << progress_bar(job, rate, 100);
      }
    }
  }
}

TEST(ProgressBar, TellsWhyARunningJobGetsNoFurther) {
  v1::Job stuck = eroding(100);
  stuck.set_waiting_reason("the disk is full");
  EXPECT_TRUE(progress_bar(stuck, 0, 120).ends_with(" (the disk is full)")) << progress_bar(stuck, 0, 120);
  EXPECT_EQ(progress_line(stuck, 0), "erode (the disk is full): 25.0%, 100/400 directions");
}

class ProgressViewTest : public ::testing::Test {
 protected:
  void show(ConsoleStyle style, const std::vector<v1::Job>& jobs) {
    Console console(out_, err_, style);
    ProgressView view(console, [this] { return now_; });
    for (const v1::Job& job : jobs) {
      view.update(job);
      now_ += std::chrono::seconds(1);
    }
  }
  ProgressView::Clock::time_point now_{};
  std::ostringstream out_, err_;
};

TEST_F(ProgressViewTest, PlainLinesComeAtStagesAndTenths) {
  v1::Job queued;
  queued.set_state(v1::JOB_STATE_QUEUED);
  show({}, {queued, queued, eroding(0), eroding(10), eroding(39), eroding(40), eroding(400)});
  EXPECT_EQ(err_.str(),
            "queued\nerode: 0.0%, 0/400 directions\nerode: 10.0%, 40/400 directions, 10/s\n"
            "erode: 100.0%, 400/400 directions, 180/s\n");
}

TEST_F(ProgressViewTest, WhatHasEndedHasNoRate) {
  v1::Job cancelled = eroding(150);
  cancelled.set_state(v1::JOB_STATE_CANCELLED);
  show({}, {eroding(0), eroding(100), cancelled});
  EXPECT_EQ(err_.str(),
            "erode: 0.0%, 0/400 directions\nerode: 25.0%, 100/400 directions, 100/s\n"
            "cancelled: 37.5%, 150/400 directions\n");
}

TEST_F(ProgressViewTest, ASteadyRateIsMeasuredExactly) {
  show({}, {eroding(0), eroding(100), eroding(200)});
  EXPECT_EQ(err_.str(),
            "erode: 0.0%, 0/400 directions\nerode: 25.0%, 100/400 directions, 100/s\n"
            "erode: 50.0%, 200/400 directions, 100/s\n");
}

// What workers did before the first look comes in one lot, a moment after it.
TEST_F(ProgressViewTest, ARateIsToldOnceASecondIsMeasured) {
  Console console(out_, err_, {});
  ProgressView view(console, [this] { return now_; });
  view.update(eroding(0));
  now_ += std::chrono::microseconds(400);
  view.update(eroding(100));
  now_ += std::chrono::seconds(2);
  view.update(eroding(200));
  now_ += std::chrono::milliseconds(300);
  view.update(eroding(300));
  now_ += std::chrono::milliseconds(700);
  view.update(eroding(300));
  now_ += std::chrono::seconds(1);
  view.update(eroding(400));
  EXPECT_EQ(err_.str(),
            "erode: 0.0%, 0/400 directions\nerode: 50.0%, 200/400 directions, 100/s\n"
            "erode: 75.0%, 300/400 directions, 100/s\nerode: 100.0%, 400/400 directions, 100/s\n");
}

TEST_F(ProgressViewTest, TheTimeLeftIsTheServers) {
  v1::Job job = eroding(200);
  job.set_remaining_ms(65000);
  show({}, {job});
  EXPECT_EQ(err_.str(), "erode: 50.0%, 200/400 directions, 1 min 05 s left\n");
}

TEST_F(ProgressViewTest, OnATerminalTheLineIsRedrawnAndRemoved) {
  ConsoleStyle style;
  style.terminal = true;
  show(style, {eroding(100)});
  EXPECT_EQ(err_.str().substr(0, 4), "\r\033[K");
  EXPECT_EQ(err_.str().substr(err_.str().size() - 4), "\r\033[K");
  EXPECT_EQ(err_.str().find('\n'), std::string::npos);
}

TEST_F(ProgressViewTest, QuietShowsNothing) {
  ConsoleStyle style;
  style.quiet = style.terminal = true;
  show(style, {eroding(100), eroding(200)});
  EXPECT_EQ(err_.str(), "");
}

TEST(ServerDetails, CountTheWorkersThatAreThere) {
  v1::ServerInfo info;
  v1::WorkerInfo* busy = info.add_workers();
  busy->set_id("a");
  busy->set_threads(1);
  busy->set_last_seen_ms(9000);
  busy->set_task("erode 123");
  EXPECT_NE(server_details(info, 10000).find("workers:              1\n"), std::string::npos);
  v1::WorkerInfo* gone = info.add_workers();
  gone->set_id("b");
  gone->set_threads(2);
  gone->set_silent(true);
  const std::string text = server_details(info, 10000);
  EXPECT_NE(text.find("workers:              1 and 1 silent\n"), std::string::npos) << text;
  EXPECT_NE(text.find("1 thread, "), std::string::npos) << text;
  EXPECT_NE(text.find("ago, erode 123\n"), std::string::npos) << text;
  EXPECT_NE(text.find("ago, silent: dead, stopped or cut off\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace affskel::client
