#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "store/full_disk_fixture.h"

namespace affskel::server {
namespace {

TEST_F(FullDiskTest, JobsAreCancelledAndDeletedWhereNothingElseCanBeWritten) {
  const v1::Job kept = complete_job(3000, 40, "kept");
  const v1::Job old = submit("OFF 2", "old");
  erode(100000, 20);
  derive();
  const v1::Job running = submit("OFF 3", "running");
  prepare(100000, 40);
  const v1::Lease block = lease();
  disk_.leave(3 * kMiB);
  report_until_full(block, block.positions(0).begin());
  EXPECT_TRUE(store_->disk_full());
  disk_.leave(options_.reserve_bytes / 2);
  const std::uint64_t used = disk_.used();

  EXPECT_THROW(submit("OFF 4"), SqliteError);
  EXPECT_FALSE(store_->lease(worker_identity("worker-b"), "", false)) << "its work could not be stored";
  EXPECT_EQ(store_->cancel(running.id()).state(), v1::JOB_STATE_RUNNING);
  const std::uint64_t next = block.positions(0).end() - 1;
  EXPECT_STORE_ERROR(report(block, next, next + 1), kFenced);
  EXPECT_EQ(store_->job(running.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(store_->remove(running.id()), running.id());
  EXPECT_EQ(store_->remove(old.id()), old.id());
  tidy_up();
  EXPECT_LE(disk_.used() - bytes_of("reserve") + 2 * kMiB, used) << "a field of 2 MB and a log are gone";
  EXPECT_LE(bytes_of("affskel.db"), 2 * kMiB);
  EXPECT_EQ(bytes_of("affskel.db-wal"), 0U);

  EXPECT_FALSE(store_->disk_full());
  EXPECT_EQ(bytes_of("reserve"), options_.reserve_bytes);
  EXPECT_EQ(field(kept.id()), expected_field(3000, 40));
  EXPECT_EQ(submit("OFF 4").state(), v1::JOB_STATE_QUEUED);
}

/// Holds up every call that found the disk full until all of them have: a store that finds its disk full asks
/// for the time before it gives the reserve away.
class AllFindItFull final : public Clock {
 public:
  AllFindItFull(const Clock& clock, const SmallDisk& disk, std::ptrdiff_t users)
      : clock_(clock), disk_(disk), users_to_come_(users) {}

  std::int64_t wall_ms() const override {
    in_transaction_ = true;  // it asks for both times, in this order
    return clock_.wall_ms();
  }
  std::int64_t lease_ms() const override {
    if (!std::exchange(in_transaction_, false) && disk_.refused_this_thread() && !counted_) {
      counted_ = true;
      ++found_it_full_;
      users_to_come_.arrive_and_wait();
    }
    return clock_.lease_ms();
  }

  /// The user of this thread has done what he wanted: the others do not wait for him.
  void leave() const {
    if (!counted_) users_to_come_.count_down();
  }

  std::ptrdiff_t found_it_full() const { return found_it_full_; }

 private:
  const Clock& clock_;
  const SmallDisk& disk_;
  mutable std::latch users_to_come_;
  mutable std::atomic<std::ptrdiff_t> found_it_full_ = 0;
  inline static thread_local bool counted_ = false;
  inline static thread_local bool in_transaction_ = false;
};

// All of them find the disk full before the first gives the reserve away: the others may use it, too.
TEST_F(FullDiskTest, EverybodyMayCancelWhenTheDiskGetsFull) {
  std::vector<std::string> jobs;
  for (int i = 0; i < 8; ++i) jobs.push_back(submit("OFF " + std::to_string(i), "queued").id());
  const AllFindItFull clock(clock_, disk_, std::ssize(jobs));
  store_.reset();
  store_ = std::make_unique<Store>(database(), options_, clock);
  disk_.leave(0);
  std::vector<std::thread> users;
  for (const std::string& job : jobs) {
    users.emplace_back([&] {
      EXPECT_NO_THROW(store_->cancel(job));
      clock.leave();
    });
  }
  for (std::thread& user : users) user.join();
  EXPECT_EQ(clock.found_it_full(), std::ssize(jobs));
  EXPECT_TRUE(store_->disk_full());
  for (const std::string& job : jobs) EXPECT_EQ(store_->job(job).state(), v1::JOB_STATE_CANCELLED);
  store_.reset();  // before its clock
}

TEST_F(FullDiskTest, WhatWasAcknowledgedIsKeptAndTheRestGoesOnWhenThereIsRoom) {
  const v1::Job job = submit();
  prepare(60000, 64);
  const v1::Lease block = lease();
  disk_.leave(4 * kMiB);
  const std::uint64_t first = block.positions(0).begin();
  const std::uint64_t acknowledged = report_until_full(block, first) - first;
  ASSERT_GT(acknowledged, 0U);
  EXPECT_EQ(store_->job(job.id()).directions_done(), acknowledged);

  store_.reset();
  disk_.leave(options_.reserve_bytes / 2);
  open();
  EXPECT_TRUE(store_->disk_full());
  EXPECT_EQ(store_->job(job.id()).directions_done(), acknowledged);
  EXPECT_THROW(report(block, first + acknowledged, first + acknowledged + 1), SqliteError);

  disk_.leave(100 * kMiB);
  store_->tidy();
  EXPECT_FALSE(store_->disk_full());
  for (std::uint64_t position = first + acknowledged; position < block.positions(0).end(); ++position) {
    report(block, position, position + 1, position + 1 == block.positions(0).end());
  }
  finish_blocks();
  derive();
  EXPECT_TRUE(field(job.id()) == expected_field(60000, 64));
}

TEST_F(FullDiskTest, AWorkerThatTriesAgainKeepsItsLease) {
  const v1::Job job = submit();
  prepare(50000, 64);
  const v1::Lease block = lease();
  const v1::Lease next = lease();  // what it computes there it reports after this one
  disk_.leave(3 * kMiB);
  const std::uint64_t at = report_until_full(block, block.positions(0).begin());
  disk_.leave(kMiB);  // others take what the log has given back
  for (const std::int64_t end = clock_.lease_ms() + 2 * options_.stall_ms; clock_.lease_ms() < end;) {
    clock_.advance(options_.lease_ms / 4);
    for (const v1::Lease& held : {block, next}) EXPECT_NO_THROW(store_->renew(held.token()));
    EXPECT_THROW(report(block, at, at + 1), SqliteError);
    ASSERT_EQ(store_->expire_leases(), 0);
  }
  EXPECT_NO_THROW(store_->renew(next.token()));
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 0U);
  clock_.advance(options_.lease_ms + 1);
  EXPECT_EQ(store_->expire_leases(), 2) << "silent workers lose theirs as ever";
}

TEST_F(FullDiskTest, AResultThatIsRefusedKeepsTheOtherLeasesOfItsWorker) {
  const std::string done = complete_job(10, 20).id();
  submit("OFF 2");
  prepare(50000, 64);
  const v1::Lease block = lease();
  store_->open_artifact(skeleton_request(done, 3));
  const v1::Lease task = lease();
  ASSERT_EQ(task.kind(), v1::TASK_KIND_SKELETON);
  const std::string large(5 * kMiB, 's');
  const v1::CompleteTaskHeader header = derive_header(task.token(), large, 3);
  disk_.leave(kMiB / 2);
  for (const std::int64_t end = clock_.lease_ms() + 2 * options_.stall_ms; clock_.lease_ms() < end;) {
    clock_.advance(options_.lease_ms / 4);
    for (const v1::Lease& held : {block, task}) EXPECT_NO_THROW(store_->renew(held.token()));
    EXPECT_THROW(store_->complete(header, large), SqliteError);
    ASSERT_EQ(store_->expire_leases(), 0);
  }
  disk_.leave(100 * kMiB);
  store_->tidy();
  EXPECT_NO_THROW(store_->complete(header, large));
  EXPECT_NO_THROW(report(block, 0, 1));
}

TEST_F(FullDiskTest, AResultThatIsRefusedEndsWithItsCancelledJob) {
  const v1::Job job = submit();
  erode(10, 20);
  const v1::Lease task = lease();
  const std::string large(5 * kMiB, 's');
  disk_.leave(kMiB / 2);
  EXPECT_THROW(store_->complete(derive_header(task.token(), large, 3), large), SqliteError);
  store_->cancel(job.id());
  EXPECT_STORE_ERROR(store_->complete(derive_header(task.token(), large, 3), large), kFenced);
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_CANCELLED);
}

// The patience of a job follows from its longest pause between two reports.
TEST_F(FullDiskTest, AWaitForTheDiskIsNoPauseBetweenReports) {
  submit();
  prepare(50000, 64);
  const v1::Lease block = lease(), next = lease();
  disk_.leave(3 * kMiB);
  const std::uint64_t at = report_until_full(block, block.positions(0).begin());
  disk_.leave(kMiB);
  for (const std::int64_t end = clock_.lease_ms() + options_.stall_ms / 4; clock_.lease_ms() < end;) {
    clock_.advance(options_.lease_ms / 4);
    for (const v1::Lease& held : {block, next}) EXPECT_NO_THROW(store_->renew(held.token()));
    EXPECT_THROW(report(block, at, at + 1), SqliteError);
  }
  disk_.leave(100 * kMiB);
  store_->tidy();
  report(block, at, at + 1);
  const std::uint64_t first = next.positions(0).begin();
  report(next, first, first + 1);
  for (const std::int64_t end = clock_.lease_ms() + options_.stall_ms; clock_.lease_ms() <= end;) {
    clock_.advance(options_.lease_ms / 4);
    for (const v1::Lease& held : {block, next}) store_->renew(held.token());
  }
  EXPECT_EQ(store_->expire_leases(), 2) << "they have not been patient for longer than before";
}

// The report of another worker, with a pause of its own, makes the patience of all longer before the wait ends.
TEST_F(FullDiskTest, AWaitForTheDiskIsNoPauseWhateverOthersReportMeanwhile) {
  const std::string job = submit().id();
  prepare(50000, 64);
  const v1::Lease block = lease(), other = lease("worker-b");
  disk_.leave(3 * kMiB);
  const std::uint64_t at = report_until_full(block, block.positions(0).begin());
  disk_.leave(kMiB);
  for (int s = 0; s < 600; ++s) {
    clock_.advance(1000);
    store_->renew(block.token());
    if (s >= 524) store_->renew(other.token());  // it was silent until then
    store_->expire_leases();
    EXPECT_THROW(report(block, at, at + 1), SqliteError);
  }
  disk_.leave(100 * kMiB);
  store_->tidy();
  report(other, other.positions(0).begin(), other.positions(0).begin() + 1);
  report(block, at, at + 1);
  EXPECT_EQ(store_->job(job).counters().longest_report_gap_ms(), 75'000U);
}

TEST_F(FullDiskTest, APauseAfterARefusalCounts) {
  const std::string job = submit().id();
  prepare(50000, 64);
  const v1::Lease block = lease();
  disk_.leave(3 * kMiB);
  const std::uint64_t at = report_until_full(block, block.positions(0).begin());
  disk_.leave(kMiB);
  clock_.advance(options_.lease_ms);
  EXPECT_THROW(report(block, at, at + 1), SqliteError);
  disk_.leave(100 * kMiB);
  store_->tidy();
  for (int s = 0; s < 60; ++s) {
    clock_.advance(1000);
    store_->renew(block.token());
  }
  report(block, at, at + 1);
  EXPECT_EQ(store_->job(job).counters().longest_report_gap_ms(), 60'000U);
}

// The end of the last block merges the log into the field, for which there is no room.
TEST_F(FullDiskTest, AJobWhoseLastBlockEndsOnAFullDiskGoesOnWhenThereIsRoom) {
  const v1::Job job = submit();
  prepare(100000, 8);
  v1::Lease block = lease();
  for (;;) {
    const std::uint64_t begin = block.positions(0).begin(), end = block.positions(0).end();
    if (end == 8) break;
    report(block, begin, end, true);
    block = lease();
  }
  report(block, block.positions(0).begin(), block.positions(0).end());  // not called done, and then it dies
  for (const bool again : {false, true}) {
    disk_.leave(0);
    clock_.advance(options_.lease_ms + 1);
    EXPECT_NO_THROW(store_->expire_leases());
    EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_RUNNING);
    EXPECT_EQ(store_->job(job.id()).stage(), v1::JOB_STAGE_ERODE) << again;
    store_.reset();  // a new server finds the disk as full
    disk_.leave(options_.reserve_bytes / 2);
    open();
  }
  disk_.leave(100 * kMiB);
  store_->tidy();
  EXPECT_EQ(store_->job(job.id()).stage(), v1::JOB_STAGE_DERIVE);
  derive();
  EXPECT_TRUE(field(job.id()) == expected_field(100000, 8));
}

TEST_F(FullDiskTest, AJobTooLargeForTheDiskHoldsOthersUpOnlyUntilItIsCancelledOrAMinuteHasPassed) {
  const v1::Job large = submit();
  prepare(500000, 16);
  const v1::Lease block = lease();
  disk_.leave(5 * kMiB);
  EXPECT_THROW(report(block, 0, 1), SqliteError);
  EXPECT_THROW(report(block, 0, 1), SqliteError) << "the room that the first had taken, tried once more";
  EXPECT_THROW(submit("OFF 2"), SqliteError);
  clock_.advance(60001);
  EXPECT_NO_THROW(submit("OFF 2"));
  EXPECT_THROW(report(block, 0, 1), SqliteError);
  EXPECT_THROW(report(block, 0, 1), SqliteError);
  EXPECT_THROW(submit("OFF 3"), SqliteError);
  store_->cancel(large.id());
  EXPECT_NO_THROW(submit("OFF 3"));
}

// Everything is small here, so the log's own place is what the commits must get along with.
TEST_F(FullDiskTest, BookkeepingDoesNotUseTheReserveUp) {
  submit();
  prepare(50000, 64);
  const v1::Lease block = lease();
  disk_.leave(3 * kMiB);
  report_until_full(block, block.positions(0).begin());
  disk_.leave(options_.reserve_bytes);
  for (int i = 0; i < 200; ++i) {
    clock_.advance(1);
    store_->renew(block.token());
  }
  EXPECT_TRUE(store_->disk_full());
  EXPECT_GT(disk_.free(), 0U);
}

TEST_F(FullDiskTest, ALogThatWasCommittedNeedsNoMoreRoomToBeCopied) {
  submit();
  prepare(100000, 64);
  const v1::Lease block = lease();
  report(block, 0, 4);
  EXPECT_GT(bytes_of("affskel.db-wal"), 0U);
  disk_.leave(0);
  Database db(database(), Database::Mode::kReadWrite);
  EXPECT_TRUE(db.checkpoint());
  EXPECT_EQ(bytes_of("affskel.db-wal"), 0U);
}

TEST_F(FullDiskTest, DeletingGivesBytesBackInShortSteps) {
  const std::uint64_t empty = bytes_of("affskel.db");
  const v1::Job job = submit("OFF 2");
  erode(1000000, 16);
  derive();
  tidy_up();
  const std::uint64_t before = bytes_of("affskel.db");
  EXPECT_GT(before, 20 * kMiB);
  store_->remove(job.id());
  std::uint64_t longest_log = 0;
  int steps = 0;
  for (; store_->tidy(); ++steps) longest_log = std::max(longest_log, bytes_of("affskel.db-wal"));
  EXPECT_GT(steps, 4);
  EXPECT_LE(bytes_of("affskel.db"), empty);
  EXPECT_LT(longest_log, before / 4) << "pages that are freed are not written";
}

TEST_F(FullDiskTest, AMeshThatIsHalfGoneCanBeSubmittedAgain) {
  const std::string mesh = "OFF" + std::string(20 * kMiB, ' ');
  const v1::Job first = submit(mesh);
  store_->cancel(first.id());
  store_->remove(first.id());
  ASSERT_TRUE(store_->tidy());
  ASSERT_TRUE(store_->tidy());
  {
    Database db(database(), Database::Mode::kReadOnly);
    const std::int64_t chunks = db.integer("SELECT count(*) FROM mesh_chunks").value();
    ASSERT_GT(chunks, 0);
    ASSERT_LT(chunks, 20);
  }
  const v1::Job second = submit(mesh);
  tidy_up();
  v1::FetchArtifactRequest request = artifact_request(second.id(), v1::ARTIFACT_KIND_MESH);
  EXPECT_TRUE(read_all(*store_->open_artifact(request).reader) == mesh);
}

TEST_F(FullDiskTest, AFieldThatIsHalfGoneIsNotTakenForAnotherJob) {
  const v1::Job first = complete_job(300000, 16);
  store_->remove(first.id());
  ASSERT_TRUE(store_->tidy());
  const v1::Job second = submit();
  EXPECT_EQ(second.stage(), v1::JOB_STAGE_PREPARE);
  tidy_up();
  erode(300000, 16);
  derive();
  EXPECT_TRUE(field(second.id()) == expected_field(300000, 16));
}

TEST_F(FullDiskTest, ADatabaseOfAnOlderVersionIsRewrittenOnceSoThatItCanShrink) {
  const v1::Job job = complete_job(3000, 40);
  store_.reset();
  {
    Database db(database(), Database::Mode::kReadWrite);
    db.execute("PRAGMA auto_vacuum = NONE; VACUUM");
    ASSERT_EQ(db.integer("PRAGMA auto_vacuum"), 0);
  }
  open();
  Database db(database(), Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("PRAGMA auto_vacuum"), 2);
  EXPECT_EQ(field(job.id()), expected_field(3000, 40));
}

}  // namespace
}  // namespace affskel::server
