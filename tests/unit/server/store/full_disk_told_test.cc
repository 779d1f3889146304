// What is said of a disk that is full, and has room again.
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <sstream>
#include <string>

#include "store/full_disk_fixture.h"

namespace affskel::server {
namespace {

/// What the program logs, for as long as it lives.
class Log {
 public:
  Log() {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
  }
  ~Log() { spdlog::set_default_logger(before_); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  bool tells(const std::string& event) const {
    return text_.str().find("event=" + event) != std::string::npos;
  }

 private:
  const std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
  std::ostringstream text_;
};

// The reserve comes back whenever it may, and goes again with the next report: that is no room.
TEST_F(FullDiskTest, RoomIsToldOnceWhatWasRefusedIsWritten) {
  const Log log;
  const v1::Job large = submit();
  prepare(500000, 16);
  const v1::Lease block = lease();
  EXPECT_EQ(store_->room_wanted(large.id()), 0U);
  RecordBatch part(500000, 16, block.job().prepared().volume());
  v1::FieldRecords one;
  one.add_point(7);
  one.add_direction(0);
  one.add_erosion(made_up_erosion(7, 0));
  one.add_area(made_up_area(7, 0));
  part.append(one);
  disk_.leave(5 * kMiB);
  for (int i = 0; i < 3; ++i) {
    EXPECT_THROW(report(block, 0, 1), SqliteError);
    EXPECT_TRUE(store_->disk_full());
    for (int kept = 0; kept < 20; ++kept) {
      clock_.advance(options_.lease_ms * 3 / 4);
      store_->renew(block.token());
    }
    tidy_up();
    EXPECT_FALSE(store_->disk_full()) << "the reserve is whole for once";
    EXPECT_GT(store_->room_wanted(large.id()), options_.reserve_bytes);
    EXPECT_TRUE(store_->report_part(block.token(), part)) << "the first of a large report finds room";
    EXPECT_GT(store_->room_wanted(large.id()), options_.reserve_bytes);
  }
  const v1::Job small = submit("OFF 2");
  EXPECT_EQ(store_->room_wanted(small.id()), 0U);
  EXPECT_TRUE(log.tells("disk_full"));
  EXPECT_FALSE(log.tells("disk_has_room"));
  disk_.leave(100 * kMiB);
  EXPECT_NO_THROW(report(block, 0, 1));
  tidy_up();
  EXPECT_EQ(store_->room_wanted(large.id()), 0U);
  EXPECT_TRUE(log.tells("disk_has_room"));
}

// A large report of one block is refused while small ones of another are taken: the job is not through.
TEST_F(FullDiskTest, WhatIsWrittenOfAnotherBlockIsNotWhatWasRefused) {
  const Log log;
  const v1::Job job = submit();
  prepare(500000, 32);
  const v1::Lease block = lease(), next = lease();
  disk_.leave(5 * kMiB);
  EXPECT_THROW(report(block, 0, 1), SqliteError);
  for (int kept = 0; kept < 20; ++kept) {
    clock_.advance(options_.lease_ms * 3 / 4);
    store_->renew(block.token());
    store_->renew(next.token());
  }
  tidy_up();
  ASSERT_FALSE(store_->disk_full());
  EXPECT_NO_THROW(report(next, {next.positions(0)}, {}));
  tidy_up();
  EXPECT_GT(store_->room_wanted(job.id()), options_.reserve_bytes);
  EXPECT_FALSE(log.tells("disk_has_room"));
  disk_.leave(100 * kMiB);
  EXPECT_NO_THROW(report(block, 0, 1));
  tidy_up();
  EXPECT_TRUE(log.tells("disk_has_room"));
}

// The job is done; what was asked for of it is as good as any other result.
TEST_F(FullDiskTest, RoomIsNotToldWhileAResultOnRequestIsRefused) {
  const Log log;
  const std::string job = complete_job(10, 20).id();
  store_->open_artifact(skeleton_request(job, 3));
  const v1::Lease task = lease();
  const std::string large(20 * kMiB, 's');
  const v1::CompleteTaskHeader header = derive_header(task.token(), large, 3);
  for (const std::uint64_t left : {5 * kMiB, options_.reserve_bytes / 2}) {
    disk_.leave(left);
    EXPECT_THROW(store_->complete(header, large), SqliteError);
    EXPECT_TRUE(log.tells("disk_full"));
    disk_.leave(5 * kMiB);
    for (int kept = 0; kept < 20; ++kept) {
      clock_.advance(options_.lease_ms * 3 / 4);
      store_->renew(task.token());
    }
    tidy_up();
    ASSERT_FALSE(store_->disk_full()) << left;
    EXPECT_FALSE(log.tells("disk_has_room")) << left;
  }
  disk_.leave(100 * kMiB);
  EXPECT_NO_THROW(store_->complete(header, large));
  tidy_up();
  EXPECT_TRUE(log.tells("disk_has_room"));
}

TEST_F(FullDiskTest, StartsWhereNothingIsFreeButTheReserve) {
  const v1::Job job = submit();
  store_.reset();
  disk_.leave(0);
  const Log log;
  open();
  EXPECT_TRUE(store_->disk_full());
  EXPECT_TRUE(log.tells("disk_full"));
  EXPECT_EQ(bytes_of("reserve"), 0U);
  EXPECT_EQ(store_->cancel(job.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(store_->remove(job.id()), job.id());
  EXPECT_FALSE(log.tells("disk_has_room"));
  disk_.leave(100 * kMiB);
  tidy_up();
  EXPECT_TRUE(log.tells("disk_has_room"));
}

}  // namespace
}  // namespace affskel::server
