// Jobs that are to be cancelled once their workers know: they end whatever becomes of the workers.
#include "check/check_database.h"
#include "database/sqlite.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class PendingCancelTest : public StoreTest {
 protected:
  /// A job whose worker holds a block of it, and does not know yet.
  v1::Job cancelled_while_leased() {
    const v1::Job job = submit();
    prepare(4, 16);
    lease();
    EXPECT_EQ(store_->cancel(job.id()).state(), v1::JOB_STATE_RUNNING);
    return job;
  }

  std::string told_by_check() const {
    std::string text;
    check_database(directory_.path().string(), [&](const Fault& fault) { text += fault.what + "\n"; });
    return text;
  }
};

TEST_F(PendingCancelTest, EndsWhenTheDatabaseIsPutBack) {
  const v1::Job job = cancelled_while_leased();
  store_.reset();
  const std::filesystem::path copy = database() + ".copy";
  std::filesystem::copy(database(), copy);
  std::filesystem::rename(copy, database());
  open();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(told_by_check(), "");
}

TEST_F(PendingCancelTest, IsToldWhereNoWorkerWillEverKnow) {
  const v1::Job job = cancelled_while_leased();
  EXPECT_EQ(told_by_check(), "");
  store_.reset();
  Database(database(), Database::Mode::kReadWrite)
      .execute("UPDATE tasks SET state = 'pending', token = NULL WHERE state = 'leased'");
  EXPECT_NE(told_by_check().find("is to be cancelled, and waits for no worker"), std::string::npos);
  open();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(told_by_check(), "");
}

}  // namespace
}  // namespace affskel::server
