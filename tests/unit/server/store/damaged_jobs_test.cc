// A job whose rows a disk has changed is nobody's trouble but its own.
#include "database/sqlite.h"
#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class DamagedJobsTest : public StoreTest {
 protected:
  void damage(const std::string& script) {
    store_.reset();
    Database(database(), Database::Mode::kReadWrite).execute(script);
    open();
  }

  void expect_damaged(const v1::Job& job) {
    const v1::Job failed = store_->job(job.id());
    EXPECT_EQ(failed.state(), v1::JOB_STATE_FAILED);
    EXPECT_EQ(failed.error().code(), "DAMAGED");
  }
};

TEST_F(DamagedJobsTest, OthersGetTheirLeasesWhenOneOfItEnds) {
  const v1::Job job = submit("OFF 1", "damaged");
  erode(10, 16);
  ASSERT_EQ(lease().kind(), v1::TASK_KIND_SKELETON);
  damage("UPDATE jobs SET skeleton = x'0a'");
  const v1::Job other = submit("OFF 2", "other");
  clock_.advance(options_.lease_ms + 1);
  EXPECT_EQ(lease("another").job().id(), other.id());
  expect_damaged(job);
  EXPECT_NO_THROW(store_->expire_leases());
}

TEST_F(DamagedJobsTest, TheServerStartsBesideThem) {
  const v1::Job counted = submit("OFF 1", "miscounted");
  prepare(10, 16);
  damage("UPDATE tasks SET state = 'done' WHERE kind = 'erode'");
  expect_damaged(counted);
}

}  // namespace
}  // namespace affskel::server
