#include "metrics/metrics.h"

#include <gtest/gtest.h>
#include <prometheus/text_serializer.h>

#include "tools/exposition.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

std::map<std::string, tests::Exposed> read(const Metrics& metrics) {
  return tests::read_exposition(prometheus::TextSerializer().Serialize(metrics.collect()));
}

TEST(MetricsTest, CountWhatTheyAreTold) {
  Metrics metrics;
  metrics.call_ended("GetJob", "OK", milliseconds(2));
  metrics.call_ended("GetJob", "OK", milliseconds(20));
  metrics.call_ended("GetJob", "NOT_FOUND", milliseconds(2));
  metrics.lease_granted("erode");
  metrics.lease_lost("erode");
  metrics.lease_fenced();
  metrics.directions("ada", 10, 3);
  metrics.directions("ada", 5, 0);
  metrics.refined_points(100, 7);
  metrics.task_finished("erode", milliseconds(1500));
  metrics.stage_ended("erode", std::chrono::hours(2));
  metrics.transaction(milliseconds(1), milliseconds(3));
  const auto seen = read(metrics);
  EXPECT_EQ(value_of(seen, "affskel_calls_total", {{"method", "GetJob"}, {"code", "OK"}}), 2);
  EXPECT_EQ(value_of(seen, "affskel_calls_total", {{"method", "GetJob"}, {"code", "NOT_FOUND"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_call_duration_seconds_bucket", {{"method", "GetJob"}, {"le", "0.0025"}}),
            2);
  EXPECT_EQ(value_of(seen, "affskel_call_duration_seconds_count", {{"method", "GetJob"}}), 3);
  EXPECT_NEAR(value_of(seen, "affskel_call_duration_seconds_sum", {{"method", "GetJob"}}), 0.024, 1e-12);
  EXPECT_EQ(value_of(seen, "affskel_leases_granted_total", {{"kind", "erode"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_leases_expired_total", {{"kind", "erode"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_leases_fenced_total"), 1);
  EXPECT_EQ(value_of(seen, "affskel_directions_total"), 15);
  EXPECT_EQ(value_of(seen, "affskel_directions_repeated_total"), 3);
  EXPECT_EQ(value_of(seen, "affskel_refined_points_total"), 100);
  EXPECT_EQ(value_of(seen, "affskel_refined_points_repeated_total"), 7);
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", "ada"}}), 15);
  EXPECT_EQ(value_of(seen, "affskel_task_duration_seconds_sum", {{"kind", "erode"}}), 1.5);
  EXPECT_EQ(value_of(seen, "affskel_stage_duration_seconds_bucket", {{"stage", "erode"}, {"le", "3600"}}), 0);
  EXPECT_EQ(value_of(seen, "affskel_stage_duration_seconds_bucket", {{"stage", "erode"}, {"le", "21600"}}),
            1);
  EXPECT_EQ(value_of(seen, "affskel_transaction_duration_seconds_count"), 1);
}

TEST(MetricsTest, WhatHasNotHappenedYetIsZero) {
  const auto seen = read(Metrics());
  for (const char* kind : {"prepare", "erode", "skeleton", "eroded-surface"}) {
    EXPECT_EQ(value_of(seen, "affskel_leases_granted_total", {{"kind", kind}}), 0) << kind;
    EXPECT_EQ(value_of(seen, "affskel_leases_expired_total", {{"kind", kind}}), 0) << kind;
  }
  for (const char* state : {"done", "failed", "cancelled"})
    EXPECT_EQ(value_of(seen, "affskel_jobs_ended_total", {{"state", state}}), 0) << state;
  EXPECT_EQ(value_of(seen, "affskel_jobs_submitted_total"), 0);
  // Of every method, for the first of these is one too many.
  for (const char* method : {"SubmitJob", "FetchArtifact", "LeaseTask", "FetchInput"}) {
    for (const char* code : {"INTERNAL", "DATA_LOSS"}) {
      EXPECT_EQ(value_of(seen, "affskel_calls_total", {{"method", method}, {"code", code}}), 0) << method;
    }
  }
}

TEST(MetricsTest, ManyOwnersDoNotFillTheMemoryOfWhoeverCollects) {
  Metrics metrics;
  for (std::size_t i = 0; i < 3 * kMaxOwners; ++i) metrics.directions("owner " + std::to_string(i), 1, 0);
  metrics.directions("owner 0", 1, 0);
  const auto seen = read(metrics);
  const auto& owners = seen.at("affskel_owner_directions_total").samples;
  EXPECT_EQ(owners.size(), kMaxOwners + 1);
  double sum = 0;
  for (const tests::Sample& sample : owners) sum += sample.value;
  EXPECT_EQ(sum, 3.0 * kMaxOwners + 1) << "none is left out";
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", kOtherOwners}}), 2.0 * kMaxOwners);
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", "owner 0"}}), 2);
}

TEST(MetricsTest, NamesOfOwnersMayHoldAnything) {
  Metrics metrics;
  const std::string odd = "a\"b\\c\nd{e=\"f\"}";
  metrics.directions(odd, 1, 0);
  metrics.directions("", 2, 0);
  metrics.directions("(nobody)", 4, 0);
  metrics.directions(kOtherOwners, 8, 0);
  const auto seen = read(metrics);
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", odd}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", "(nobody)"}}), 2);
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", "((nobody)"}}), 4);
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", "((others)"}}), 8);
}

}  // namespace
}  // namespace affskel::server
