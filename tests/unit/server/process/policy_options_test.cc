#include "process/policy_options.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace affskel::server {
namespace {

constexpr std::int64_t kDayMs = std::int64_t{24} * 3600 * 1000;

TEST(PolicyOptionsTest, NothingIsLimitedAndEverythingKeptUnlessToldSo) {
  const Policy policy = parse_policy({});
  EXPECT_EQ(policy.server.queued_jobs, 0);
  EXPECT_EQ(policy.of("ada").quota.stored_bytes, 0);
  EXPECT_EQ(policy.of("ada").retention.results_age_ms, 0);
  EXPECT_EQ(policy.grace_ms, 7 * kDayMs);
}

TEST(PolicyOptionsTest, OwnersReplaceSingleNames) {
  PolicyWords words;
  words.limits = {"queued-jobs=100K", "stored-bytes=2T"};
  words.quotas = {"ada:stored-bytes=500G", "queued-jobs=2K", "stored-bytes=200G", "o:d=d:chords=1T"};
  words.retentions = {"results-age=90d", "ada:results-age=0", "jobs-age=48h", "total-bytes=1M", "grace=30s"};
  const Policy policy = parse_policy(words);
  EXPECT_EQ(policy.server.queued_jobs, 100'000);
  EXPECT_EQ(policy.server.stored_bytes, std::int64_t{2} << 40);
  EXPECT_EQ(policy.of("ada").quota.stored_bytes, std::int64_t{500} << 30);
  EXPECT_EQ(policy.of("ada").quota.queued_jobs, 2000) << "what holds for everyone, wherever it stands";
  EXPECT_EQ(policy.of("bob").quota.stored_bytes, std::int64_t{200} << 30);
  EXPECT_EQ(policy.of("o:d=d").quota.chords, 1'000'000'000'000);
  EXPECT_EQ(policy.of("bob").retention.results_age_ms, 90 * kDayMs);
  EXPECT_EQ(policy.of("ada").retention.results_age_ms, 0);
  EXPECT_EQ(policy.of("ada").retention.jobs_age_ms, 2 * kDayMs);
  EXPECT_EQ(policy.total_bytes, 1 << 20);
  EXPECT_EQ(policy.grace_ms, 30'000);
}

TEST(PolicyOptionsTest, PrioritiesAreQuotasOfOwners) {
  EXPECT_EQ(parse_policy({}).of("ada").priority, 5);
  const Policy policy = parse_policy({{}, {"ada:priority=9", "priority=3"}, {}});
  EXPECT_EQ(policy.of("ada").priority, 9);
  EXPECT_EQ(policy.of("bob").priority, 3);
  for (const char* value : {"10", "-1", "", "5K"}) {
    EXPECT_THROW(parse_policy({{}, {std::string("priority=") + value}, {}}), std::invalid_argument) << value;
  }
  EXPECT_THROW(parse_policy({{"priority=5"}, {}, {}}), std::invalid_argument);
}

TEST(PolicyOptionsTest, RefusesWhatItDoesNotUnderstand) {
  const auto why = [](const PolicyWords& words) {
    try {
      parse_policy(words);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_NE(why({{"queued-jobs"}, {}, {}}).find("expected [OWNER:]NAME=VALUE"), std::string::npos);
  EXPECT_NE(why({{"ada:queued-jobs=1"}, {}, {}}).find("not of an owner"), std::string::npos);
  EXPECT_NE(why({{}, {"jobs=1"}, {}}).find("'jobs=1': expected queued-jobs"), std::string::npos);
  for (const char* value : {"", "-1", "1.5", "1d", "1k", "9999999999T", "0x10", "1 "}) {
    EXPECT_NE(why({{}, {std::string("queued-jobs=") + value}, {}}).find("expected a whole number"),
              std::string::npos)
        << value;
  }
  for (const char* value : {"", "90", "90G", "-1d", "99999999999999d"}) {
    EXPECT_NE(why({{}, {}, {std::string("results-age=") + value}}).find("expected an age"), std::string::npos)
        << value;
  }
  EXPECT_NE(why({{}, {}, {"ada:grace=1d"}}).find("without an owner"), std::string::npos);
}

}  // namespace
}  // namespace affskel::server
