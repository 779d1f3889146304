#include "tally.h"

#include <gtest/gtest.h>

#include <map>

#include "faults.h"

namespace affskel::chaos {
namespace {

TEST(Tally, AddsUpByKind) {
  Tally tally;
  Outcome good;
  good.injected = 1;
  tally.add("a", good);
  tally.add("b", good);
  tally.add("a", good);
  EXPECT_TRUE(tally.total().good());
  EXPECT_EQ(tally.total().injected, 3U);
  EXPECT_NE(tally.table().find("| total                    |      3 |"), std::string::npos) << tally.table();
}

TEST(Tally, EveryKindOfFailureFails) {
  for (std::uint64_t Outcome::*number :
       {&Outcome::differing, &Outcome::lost, &Outcome::hangs, &Outcome::unclean, &Outcome::deaths}) {
    Outcome bad;
    bad.*number = 1;
    Tally tally;
    tally.add("a", bad);
    EXPECT_FALSE(tally.total().good());
  }
}

TEST(Schedule, EveryKindComesAsOftenAsTheOthersAndTheSeedDecidesWhen) {
  std::vector<const Fault*> kinds;
  for (const Fault& fault : faults()) kinds.push_back(&fault);
  ASSERT_GE(kinds.size(), 25U);
  std::map<const Fault*, int> times;
  const auto order = schedule(kinds, 2 * kinds.size(), 7);
  for (const Fault* fault : order) ++times[fault];
  EXPECT_EQ(times.size(), kinds.size());
  for (const auto& [fault, number] : times) EXPECT_EQ(number, 2) << fault->name;
  EXPECT_EQ(order, schedule(kinds, 2 * kinds.size(), 7));
  EXPECT_NE(order, schedule(kinds, 2 * kinds.size(), 8));
}

}  // namespace
}  // namespace affskel::chaos
