// How long what is finished is kept.

#include "check/check_database.h"
#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

constexpr std::int64_t kDay = std::int64_t{24} * 3600 * 1000;

class RetentionTest : public StoreTest {
 protected:
  void keep(const std::function<void(Policy&)>& change) {
    change(options_.policy);
    open();
  }

  /// A finished job of its own mesh.
  std::string done(const std::string& mesh, const std::string& owner = "ada") {
    v1::SubmitJobHeader header = submit_header(mesh, mesh);
    header.set_owner(owner);
    const std::string id = store_->submit(header, mesh).job.id();
    while (store_->job(id).state() != v1::JOB_STATE_DONE) {
      const v1::Lease task = lease();
      if (task.kind() == v1::TASK_KIND_PREPARE) {
        const PrepareResult result = prepare_result(task.token(), 10, 20);
        store_->complete(result.header, result.data);
      } else if (task.kind() == v1::TASK_KIND_ERODE) {
        finish_block(task);
      } else {
        store_->complete(derive_header(task.token(), "skeleton", 3), "skeleton");
      }
    }
    clock_.advance(1000);
    return id;
  }

  void retain() {
    while (store_->retain()) {
    }
  }
  void tidy() {
    while (store_->tidy()) {
    }
  }

  std::uint64_t expires(const std::string& job) { return store_->job(job).expires_ms(); }
  bool removed(const std::string& job) { return store_->job(job).removed_ms() > 0; }
  bool is_there(const std::string& job) {
    try {
      store_->job(job);
      return true;
    } catch (const StoreError&) {
      return false;
    }
  }

  void expect_sound() {
    std::string faults;
    check_database(directory_.path(),
                   [&](const Fault& fault) { faults += fault.where + ": " + fault.what + "\n"; });
    EXPECT_EQ(faults, "");
  }
};

TEST_F(RetentionTest, NothingGoesUnlessToldSo) {
  const std::string job = done("OFF 1");
  clock_.advance(4000 * kDay);
  EXPECT_FALSE(store_->retain());
  EXPECT_EQ(expires(job), 0U);
}

TEST_F(RetentionTest, ResultsGoByAgeThenTheJobEachAfterItsNotice) {
  keep([](Policy& policy) {
    policy.everyone.retention = {30 * kDay, 90 * kDay, 0};
    policy.grace_ms = 7 * kDay;
  });
  const std::string job = done("OFF 1");
  clock_.advance(22 * kDay);
  retain();
  EXPECT_EQ(expires(job), 0U) << "not yet";
  clock_.advance(1 * kDay);
  retain();
  EXPECT_EQ(expires(job), static_cast<std::uint64_t>(clock_.wall_ms() + 7 * kDay)) << "told a week ahead";
  clock_.advance(7 * kDay - 2000);
  retain();
  EXPECT_FALSE(removed(job));
  EXPECT_EQ(field(job), expected_field(10, 20));
  clock_.advance(2000);
  retain();
  EXPECT_TRUE(removed(job));
  EXPECT_EQ(store_->job(job).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(store_->job(job).prepared().points(), 10U) << "what it is like stays known";
  expect_sound();
  tidy();
  expect_sound();
  clock_.advance(60 * kDay);
  retain();
  EXPECT_TRUE(is_there(job));
  EXPECT_GT(expires(job), 0U);
  clock_.advance(7 * kDay);
  retain();
  EXPECT_FALSE(is_there(job));
  tidy();
  Database db(database(), Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("SELECT count(*) FROM meshes"), 0);
  EXPECT_EQ(db.integer("SELECT count(*) FROM erosions"), 0);
}

// A server that was off for long still gives notice.
TEST_F(RetentionTest, NoticeIsGivenHoweverLateItIs) {
  const std::string job = done("OFF 1");
  clock_.advance(400 * kDay);
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = 30 * kDay;
    policy.grace_ms = 7 * kDay;
  });
  retain();
  EXPECT_EQ(expires(job), static_cast<std::uint64_t>(clock_.wall_ms() + 7 * kDay));
  EXPECT_FALSE(removed(job));
  open();
  clock_.advance(7 * kDay);
  retain();
  EXPECT_TRUE(removed(job)) << "the notice holds across a restart";
}

TEST_F(RetentionTest, AFetchSaysWhatHappenedAndResumeComputesAgain) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.grace_ms = 0;
  });
  const std::string job = done("OFF 1");
  clock_.advance(2 * kDay);
  retain();
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(v1::ARTIFACT_KIND_MESH);
  EXPECT_EQ(read_all(*store_->open_artifact(request).reader), "OFF 1");
  for (const v1::ArtifactKind kind :
       {v1::ARTIFACT_KIND_FIELD, v1::ARTIFACT_KIND_LATTICE, v1::ARTIFACT_KIND_SKELETON}) {
    request.set_kind(kind);
    try {
      store_->open_artifact(request);
      ADD_FAILURE() << "kind " << kind;
    } catch (const StoreError& error) {
      EXPECT_EQ(error.code(), StoreError::Code::kPrecondition);
      EXPECT_NE(std::string(error.what()).find("removed by retention, its mesh is kept: resume"),
                std::string::npos);
    }
  }
  EXPECT_EQ(store_->resume(job).state(), v1::JOB_STATE_QUEUED);
  EXPECT_FALSE(removed(job));
  expect_sound();
  erode(10, 20);
  derive();
  EXPECT_EQ(field(job), expected_field(10, 20));
  EXPECT_EQ(store_->job(job).state(), v1::JOB_STATE_DONE);
  tidy();
  expect_sound();
}

// Another job of the owner may still have the field; of other owners' nothing is learnt.
TEST_F(RetentionTest, ResultsThatTheOwnerKeepsAreTakenOverByResume) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.owners["bob"];
    policy.grace_ms = 0;
  });
  const std::string job = done("OFF 1");
  const std::string bobs = done("OFF 1", "bob");
  v1::SubmitJobHeader again = submit_header("OFF 1", "again");
  again.set_owner("ada");
  const v1::Job kept = store_->submit(again, "OFF 1").job;
  ASSERT_NE(kept.id(), job);
  ASSERT_EQ(kept.state(), v1::JOB_STATE_DONE) << "it shares the field";
  store_->pin(kept.id(), true);
  clock_.advance(2 * kDay);
  retain();
  tidy();
  EXPECT_TRUE(removed(job));
  EXPECT_EQ(field(bobs), expected_field(10, 20));
  EXPECT_EQ(store_->resume(job).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(field(job), expected_field(10, 20));
  store_->remove(kept.id());
  clock_.advance(2 * kDay);
  retain();
  EXPECT_TRUE(removed(job));
  EXPECT_EQ(store_->resume(job).state(), v1::JOB_STATE_QUEUED) << "bob's is there, but is bob's";
  expect_sound();
}

// A worker that has held the job's field knows more than the server then does.
TEST_F(RetentionTest, TheFieldThatIsComputedAgainIsAnotherOne) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.grace_ms = 0;
  });
  const std::string job = submit("OFF 1").id();
  prepare(100, 16);
  const v1::Lease before = lease();
  report(before, 0, 10);
  store_->cancel(job);
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  clock_.advance(2 * kDay);
  retain();
  tidy();
  ASSERT_TRUE(removed(job));
  store_->resume(job);
  const v1::Lease again = lease();
  EXPECT_EQ(again.job().id(), job);
  EXPECT_NE(again.field(), before.field());
}

TEST_F(RetentionTest, SubmittingTheSameAgainMakesANewJob) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.grace_ms = 0;
  });
  const std::string job = done("OFF 1");
  clock_.advance(2 * kDay);
  retain();
  EXPECT_NE(submit("OFF 1", "OFF 1").id(), job) << "a job without results answers nobody";
}

TEST_F(RetentionTest, PinnedAndUnfinishedJobsStay) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.everyone.retention.stored_bytes = 1;
    policy.grace_ms = kDay;
  });
  const std::string pinned = done("OFF 1"), late = done("OFF 2");
  const std::string waiting = submit("OFF 3", "waiting").id();
  EXPECT_TRUE(store_->pin(pinned, true).pinned());
  retain();
  EXPECT_EQ(expires(pinned), 0U);
  EXPECT_GT(expires(late), 0U);
  EXPECT_EQ(store_->pin(late, true).expires_ms(), 0U) << "in the time that the notice leaves";
  clock_.advance(40 * kDay);
  retain();
  for (const std::string& job : {pinned, late, waiting}) EXPECT_FALSE(removed(job));
  EXPECT_EQ(store_->job(waiting).state(), v1::JOB_STATE_QUEUED);
  store_->pin(late, false);
  retain();
  clock_.advance(kDay);
  retain();
  EXPECT_TRUE(removed(late));
  EXPECT_FALSE(removed(pinned));
}

TEST_F(RetentionTest, WhatSomebodyWaitsForStays) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.grace_ms = kDay / 2;
  });
  const std::string job = done("OFF 1");
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(v1::ARTIFACT_KIND_SKELETON);
  request.mutable_skeleton()->set_threshold(3);
  const std::int64_t task = store_->open_artifact(request).task;
  clock_.advance(kDay);
  retain();
  clock_.advance(kDay);
  retain();
  EXPECT_FALSE(removed(job));
  store_->withdraw(task);
  retain();
  clock_.advance(kDay);
  retain();
  EXPECT_TRUE(removed(job));
}

// Only as much as is needed, the oldest first, results before meshes.
TEST_F(RetentionTest, BytesOfAnOwner) {
  std::vector<std::string> jobs;
  for (int i = 1; i <= 4; ++i) jobs.push_back(done("OFF " + std::to_string(i)));
  const std::string bobs = done("OFF 9", "bob");
  Database db(database(), Database::Mode::kReadOnly);
  const std::int64_t all = db.integer("SELECT stored_bytes FROM owner_use WHERE owner = 'ada'").value();
  const std::int64_t each = (all - 20) / 4;
  keep([&](Policy& policy) {
    policy.everyone.retention.stored_bytes = all - each - 10;  // one is not enough
    policy.grace_ms = kDay;
  });
  retain();
  EXPECT_EQ(expires(jobs[0]), static_cast<std::uint64_t>(clock_.wall_ms() + kDay));
  EXPECT_GT(expires(jobs[1]), 0U);
  EXPECT_EQ(expires(jobs[2]), 0U);
  EXPECT_EQ(expires(bobs), 0U);
  store_->remove(jobs[3]);
  clock_.advance(kDay);
  retain();
  EXPECT_TRUE(removed(jobs[0]));
  EXPECT_FALSE(removed(jobs[1])) << "there is room by then";
  EXPECT_EQ(expires(jobs[1]), 0U) << "and the plan is taken back";
  expect_sound();
}

TEST_F(RetentionTest, MeshesGoWhenAllResultsAreGone) {
  std::vector<std::string> jobs;
  for (int i = 1; i <= 3; ++i) jobs.push_back(done("OFF " + std::to_string(i)));
  keep([&](Policy& policy) {
    policy.total_bytes = 10;  // two meshes
    policy.grace_ms = 0;
  });
  retain();
  EXPECT_FALSE(is_there(jobs[0]));
  EXPECT_TRUE(removed(jobs[1]));
  EXPECT_TRUE(removed(jobs[2]));
  expect_sound();
}

TEST_F(RetentionTest, PartialResultsOfCancelledJobsGoToo) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.grace_ms = 0;
  });
  const std::string job = submit("OFF 1").id();
  prepare(100, 16);
  report(lease(), 0, 10);
  store_->cancel(job);
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  clock_.advance(2 * kDay);
  retain();
  EXPECT_TRUE(removed(job));
  EXPECT_EQ(store_->job(job).state(), v1::JOB_STATE_CANCELLED);
  expect_sound();
  tidy();
  EXPECT_EQ(store_->resume(job).directions_done(), 0U);
  EXPECT_FALSE(removed(job));
  erode(100, 16);
  EXPECT_EQ(field(job), expected_field(100, 16));
}

// Of these there are no results: the job itself is what retention has, and nothing else is told.
TEST_F(RetentionTest, JobsThatNeverHadResultsGoByTheirAgeAlone) {
  keep([](Policy& policy) {
    policy.everyone.retention = {kDay, 10 * kDay, 0};
    policy.grace_ms = 0;
  });
  const std::string job = submit("OFF 1").id();
  store_->cancel(job);
  ASSERT_EQ(store_->job(job).state(), v1::JOB_STATE_CANCELLED);
  clock_.advance(2 * kDay);
  retain();
  EXPECT_FALSE(removed(job));
  EXPECT_EQ(expires(job), 0U);
  clock_.advance(9 * kDay);
  retain();
  EXPECT_FALSE(is_there(job));
  const std::string other = submit("OFF 2").id();
  store_->cancel(other);
  const std::string finished = done("OFF 3");
  keep([](Policy& policy) {
    policy.everyone.retention = {};
    policy.total_bytes = 1;
    policy.grace_ms = kDay;
  });
  retain();
  EXPECT_GT(expires(finished), 0U) << "results before meshes";
  clock_.advance(kDay);
  retain();
  EXPECT_TRUE(removed(finished));
  clock_.advance(kDay);
  retain();
  EXPECT_FALSE(is_there(other));
  expect_sound();
}

TEST_F(RetentionTest, OwnersMayHaveRulesOfTheirOwn) {
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.owners["bob"] = policy.everyone;
    policy.owners["bob"].retention.results_age_ms = 0;
    policy.grace_ms = 0;
  });
  const std::string adas = done("OFF 1"), bobs = done("OFF 2", "bob");
  clock_.advance(10 * kDay);
  retain();
  EXPECT_TRUE(removed(adas));
  EXPECT_FALSE(removed(bobs));
}

// Between any two steps workers lease, and no step removes many jobs.
TEST_F(RetentionTest, ALongRunGoesInShortStepsAndTheFileShrinks) {
  constexpr int kJobs = 1'000;
  const std::string like = done("OFF 1");
  {
    // As submitted and computed one by one: with fields of their own.
    const std::string mesh = store_->job(like).mesh_sha256();
    Database db(database(), Database::Mode::kReadWrite);
    Transaction transaction(db);
    for (int i = 0; i < kJobs; ++i) {
      db.run(
          "INSERT INTO erosions (mesh_sha256, params, params_key, core_version, prepared, points, "
          "directions, stride,"
          " directions_done, finished) SELECT mesh_sha256, params, params_key || ?2, core_version, prepared, "
          "points,"
          " directions, stride, directions_done, 1 FROM erosions WHERE mesh_sha256 = ?1 LIMIT 1",
          mesh, i);
      const std::int64_t erosion = db.last_insert_rowid();
      db.run("INSERT INTO field_chunks (erosion_id, idx, data) VALUES (?, 0, zeroblob(8000))", erosion);
      db.run(
          "INSERT INTO jobs (id, name, owner, priority, state, stage, erosion_id, skeleton, skeleton_key, "
          "created_ms,"
          " finished_ms) SELECT lower(hex(randomblob(16))), name, owner, priority, state, stage, ?2, "
          "skeleton,"
          " skeleton_key, created_ms, finished_ms FROM jobs WHERE id = ?1",
          like, erosion);
    }
    transaction.commit();
  }
  keep([](Policy& policy) {
    policy.everyone.retention.results_age_ms = kDay;
    policy.grace_ms = kDay;
  });
  const auto before = std::filesystem::file_size(database());
  submit("OFF 2");
  const auto removed_jobs = [&] {
    Database db(database(), Database::Mode::kReadOnly);
    return db.integer("SELECT count(*) FROM jobs WHERE removed_ms > 0").value();
  };
  retain();
  clock_.advance(2 * kDay);
  std::int64_t seen = 0, steps = 0;
  while (store_->retain()) {
    if (++steps % 10 == 0) {
      EXPECT_TRUE(has_work());
      const std::int64_t now = removed_jobs();
      EXPECT_LE(now - seen, 10 * 20);
      seen = now;
    }
    store_->tidy();
  }
  EXPECT_EQ(removed_jobs(), kJobs + 1);
  tidy();
  EXPECT_LT(std::filesystem::file_size(database()), before / 3 * 2);
}

}  // namespace
}  // namespace affskel::server
