// Owners take turns: the order of grants against the rule, computed here by itself.

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>

#include "store_fixture.h"

namespace affskel::server {
namespace {

class TurnTest : public StoreTest {
 protected:
  std::string submit_as(const std::string& owner, std::uint32_t priority = 5) {
    const std::string mesh = "OFF " + std::to_string(++meshes_);
    v1::SubmitJobHeader header = submit_header(mesh, mesh);
    header.set_owner(owner);
    header.set_priority(priority);
    return store_->submit(header, mesh).job.id();
  }

  /// Leases, and prepares if that is the task: then the job has blocks.
  v1::Lease take(const std::string& worker, const std::string& held = "") {
    std::optional<v1::Lease> lease = store_->lease(worker_identity(worker), held, false);
    if (!lease) throw std::logic_error("expected work, found none");
    return *lease;
  }

  void finish(const v1::Lease& lease, std::uint32_t directions = 512) {
    if (lease.kind() == v1::TASK_KIND_PREPARE) {
      const PrepareResult result = prepare_result(lease.token(), 2, directions);
      store_->complete(result.header, result.data);
    } else if (lease.kind() == v1::TASK_KIND_ERODE) {
      finish_block(lease);
    } else {
      store_->complete(derive_header(lease.token(), "x", 1), "x");
    }
  }

  /// Owners of the next grants, one worker that does one task after the other.
  std::string owners(int grants, const std::string& worker = "solo") {
    std::string names;
    for (int i = 0; i < grants; ++i) {
      const v1::Lease task = take(worker, held_);
      held_ = task.job().id();
      names += task.job().owner().substr(0, 1);
      finish(task);
    }
    return names;
  }

  std::string held_;

 private:
  int meshes_ = 0;
};

TEST_F(TurnTest, OwnersTakeTurnsHoweverManyJobsTheyHave) {
  for (int i = 0; i < 20; ++i) submit_as("ada");
  submit_as("bob");
  submit_as("cy");
  EXPECT_EQ(owners(12), "abcabcabcabc");
}

// The later owner is next, and has every second grant from then on.
TEST_F(TurnTest, ANewOwnerIsNext) {
  for (int i = 0; i < 10; ++i) submit_as("ada");
  EXPECT_EQ(owners(3), "aaa");
  submit_as("bob");
  EXPECT_EQ(owners(6), "bababa");
}

// Asking for little again and again is no way to the front.
TEST_F(TurnTest, AnOwnersLastTurnIsRemembered) {
  submit_as("ada");
  submit_as("bob");
  std::string names;
  for (int i = 0; i < 8; ++i) {
    const v1::Lease task = take("solo");
    names += task.job().owner().substr(0, 1);
    if (task.job().owner() != "bob") {
      store_->fail(task.token(), v1::JobError(), false);
      store_->remove(task.job().id());
      submit_as("ada");
    } else {
      finish(task);
    }
  }
  EXPECT_EQ(names, "abababab");
}

TEST_F(TurnTest, PriorityComesBeforeTurns) {
  submit_as("ada", 5);
  for (int i = 0; i < 3; ++i) submit_as("bob", 4);
  EXPECT_EQ(owners(5), "aaaaa");
}

// Every owner could take 9.
TEST_F(TurnTest, AcrossOwnersAPriorityCountsUpToTheQuota) {
  submit_as("ada", 9);
  submit_as("bob", 5);
  EXPECT_EQ(owners(6), "ababab");
  options_.policy.owners["ada"].priority = 9;
  open();
  EXPECT_EQ(owners(3), "aaa");
  options_.policy.owners.clear();
  options_.policy.everyone.priority = 4;
  open();
  const std::string mixed = owners(6);
  EXPECT_EQ(std::count(mixed.begin(), mixed.end(), 'a'), 3) << mixed;
}

TEST_F(TurnTest, AmongAnOwnersOwnJobsEveryPriorityCounts) {
  const std::string low = submit_as("ada", 5), high = submit_as("ada", 9);
  const v1::Lease first = take("solo");
  EXPECT_EQ(first.job().id(), high);
  finish(first);
  submit_as("bob", 5);
  std::set<std::string> seen;
  for (int i = 0; i < 8; ++i) {
    const v1::Lease task = take("other", low);
    seen.insert(task.job().id());
    finish(task);
  }
  EXPECT_FALSE(seen.contains(low)) << "held, but not the first of its owner's";
}

TEST_F(TurnTest, ARestartForgetsNoTurn) {
  for (const char* owner : {"ada", "bob", "cy"}) submit_as(owner);
  EXPECT_EQ(owners(4), "abca");
  open();
  EXPECT_EQ(owners(4), "bcab");
}

TEST_F(TurnTest, AnOwnersOldestJobComesFirst) {
  const std::string first = submit_as("ada"), second = submit_as("ada");
  std::set<std::string> seen;
  while (store_->job(first).state() != v1::JOB_STATE_DONE) {
    const v1::Lease task = take("solo");
    seen.insert(task.job().id());
    finish(task);
  }
  EXPECT_EQ(seen, std::set<std::string>{first});
  EXPECT_EQ(take("solo").job().id(), second);
}

TEST_F(TurnTest, AnOwnersJobsTakeTurnsWhereConfiguredSo) {
  options_.owner_order = OwnerOrder::kRoundRobin;
  open();
  const std::array<std::string, 3> jobs = {submit_as("ada"), submit_as("ada"), submit_as("ada")};
  for (int round = 0; round < 4; ++round) {
    for (const std::string& job : jobs) {
      const v1::Lease task = take("solo");
      EXPECT_EQ(task.job().id(), job) << "round " << round;
      finish(task);
    }
    if (round == 1) open();
  }
  options_.owner_order = OwnerOrder::kFirstCome;
  open();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(lease("w" + std::to_string(i)).job().id(), jobs[0]);
}

// Another mesh for every block would cost more than the turns are worth.
TEST_F(TurnTest, WorkersStayWithTheirJobsWhileOwnersHaveEquallyMany) {
  submit_as("ada");
  submit_as("bob");
  std::map<std::string, v1::Lease> held;
  for (const char* worker : {"one", "two"}) finish(held[worker] = take(worker));
  const std::string ada = held["one"].job().id(), bob = held["two"].job().id();
  for (const char* worker : {"one", "two"}) held[worker] = take(worker, held[worker].job().id());
  std::mt19937 random(3);
  // One of them may be much faster.
  for (int i = 0; i < 20; ++i) {
    const std::string worker = random() % 4 == 0 ? "two" : "one";
    const v1::Lease next = take(worker, held[worker].job().id());
    EXPECT_EQ(next.job().id(), worker == "one" ? ada : bob);
    finish(held[worker]);
    held[worker] = next;
  }
}

// Of W workers that all hold jobs of one owner, each does at most the block in hand before another's job is
// served; and it has half of them soon.
TEST_F(TurnTest, HeldJobsDelayNobodyByMoreThanABlockPerWorker) {
  constexpr int kWorkers = 4;
  for (int i = 0; i < 100; ++i) submit_as("ada");
  std::vector<v1::Lease> held(kWorkers);
  const auto name = [](int i) { return "w" + std::to_string(i); };
  for (int i = 0; i < kWorkers; ++i) held[static_cast<std::size_t>(i)] = take(name(i));
  const auto step = [&](int i) {
    v1::Lease& now = held[static_cast<std::size_t>(i)];
    finish(now);
    now = take(name(i), now.job().id());
    return now.job().owner();
  };
  for (int i = 0; i < 3 * kWorkers; ++i) EXPECT_EQ(step(i % kWorkers), "ada");
  const std::string bob = submit_as("bob");
  EXPECT_EQ(step(2), "bob") << "the first that is free";
  EXPECT_EQ(step(2), "bob") << "prepared, its blocks come";
  for (int i = 0; i < 12 * kWorkers; ++i) {
    const int worker = i % kWorkers;
    step(worker);
    if (i < 2 * kWorkers) continue;
    const auto bobs = std::count_if(held.begin(), held.end(),
                                    [](const v1::Lease& lease) { return lease.job().owner() == "bob"; });
    if (store_->job(bob).state() == v1::JOB_STATE_DONE) break;
    EXPECT_GE(bobs, 1) << i;
    EXPECT_LE(bobs, kWorkers / 2 + 1) << i;
  }
}

// One worker that never asks ahead, and always prefers what it holds.
TEST_F(TurnTest, AWorkerByItselfChangesBetweenOwners) {
  submit_as("ada");
  EXPECT_EQ(owners(3), "aaa");
  submit_as("bob");
  EXPECT_EQ(owners(8), "babababa");
}

TEST_F(TurnTest, RequestsTakeTurnsBetweenOwners) {
  std::map<std::string, std::string> jobs;
  for (const char* owner : {"ada", "bob"}) {
    jobs[owner] = submit_as(owner);
    while (store_->job(jobs[owner]).state() != v1::JOB_STATE_DONE) finish(take("solo"), 20);
  }
  const auto ask = [&](const std::string& owner, double threshold) {
    v1::FetchArtifactRequest request;
    request.set_job(jobs[owner]);
    request.set_kind(v1::ARTIFACT_KIND_SKELETON);
    request.mutable_skeleton()->set_threshold(threshold);
    store_->open_artifact(request);
  };
  for (int i = 0; i < 4; ++i) ask("ada", 3 + i);
  for (int i = 0; i < 2; ++i) ask("bob", 3 + i);
  EXPECT_EQ(owners(6), "ababaa");
}

// Against the rule itself, with several owners, priorities, failures, cancelled and resumed jobs.
TEST_F(TurnTest, TheIndexHasTheOrderOfTurns) {
  struct Job {
    std::string id, owner;
    std::uint32_t priority;
    int age;
  };
  std::mt19937 random(11);
  std::vector<Job> jobs;
  std::map<std::string, long>
      turns;  // as in the rule: the last grant, or the first arrival before all grants
  for (int i = 0; i < 80; ++i) {
    const std::string owner(1, static_cast<char>('a' + random() % 5));
    const auto priority = static_cast<std::uint32_t>(random() % 3);
    jobs.push_back({submit_as(owner, priority), owner, priority, i});
    turns.try_emplace(owner, i - 1000);
  }
  for (int grant = 0; !jobs.empty(); ++grant) {
    if (random() % 4 == 0) {
      const Job& job = jobs[random() % jobs.size()];
      store_->cancel(job.id);
      if (random() % 2 == 0) {
        store_->resume(job.id);
      } else {
        std::erase_if(jobs, [id = job.id](const Job& other) { return other.id == id; });
        continue;
      }
    }
    const auto next = std::min_element(jobs.begin(), jobs.end(), [&](const Job& a, const Job& b) {
      return std::tuple(-static_cast<int>(a.priority), turns[a.owner], a.age) <
             std::tuple(-static_cast<int>(b.priority), turns[b.owner], b.age);
    });
    const v1::Lease task = take("w" + std::to_string(grant));
    ASSERT_EQ(task.job().id(), next->id) << "grant " << grant;
    turns[next->owner] = grant;
    store_->fail(task.token(), v1::JobError(), false);
    jobs.erase(next);
  }
  EXPECT_FALSE(has_work());
}

}  // namespace
}  // namespace affskel::server
