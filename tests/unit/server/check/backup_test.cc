#include "check/backup.h"

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

#include "check/check_database.h"
#include "database/migrate.h"
#include "expect_store_error.h"
#include "small_disk.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

namespace fs = std::filesystem;

class BackupTest : public StoreTest {
 protected:
  std::string target() const { return (elsewhere_.path() / "copy.db").string(); }

  Backup take(const BackupOptions& options = {}) const {
    return back_up(directory_.path(), target(), options);
  }

  std::vector<std::string> files_elsewhere() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(elsewhere_.path())) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  /// A store on the copy, in a directory of its own.
  std::unique_ptr<Store> restore() const {
    const fs::path data_dir = elsewhere_.path() / "restored";
    fs::create_directory(data_dir);
    fs::copy_file(target(), data_dir / "affskel.db");
    EXPECT_EQ(check_database(data_dir, [](const Fault&) {}).faults, 0);
    return std::make_unique<Store>((data_dir / "affskel.db").string(), options_, clock_);
  }

  /// The code with which a backup is refused.
  int refused_with(const std::string& file, const BackupOptions& options = {}) const {
    try {
      back_up(directory_.path(), file, options);
    } catch (const std::system_error& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
      return error.code().value();
    }
    return 0;
  }

  TemporaryDirectory elsewhere_;
};

TEST_F(BackupTest, HasAllThatWasAcknowledgedAndNothingElseIsNeeded) {
  const v1::Job done = complete_job(5000, 40);
  const v1::Job half = submit("OFF 2", "half");
  prepare(300, 64);
  finish_block(lease());
  const Backup backup = take();
  EXPECT_TRUE(backup.complete);
  EXPECT_EQ(backup.schema, newest_schema());
  EXPECT_EQ(backup.bytes, static_cast<std::int64_t>(fs::file_size(target())));
  struct stat status {};
  ASSERT_EQ(stat(target().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
  EXPECT_EQ(files_elsewhere(), (std::vector<std::string>{"copy.db"}));

  const std::string field_before = field(done.id());
  const v1::Job before = store_->job(half.id());
  store_ = restore();
  EXPECT_TRUE(field(done.id()) == field_before);
  EXPECT_GT(before.directions_done(), 0U);
  EXPECT_EQ(store_->job(half.id()).SerializeAsString(), before.SerializeAsString());
  while (has_work()) {
    const v1::Lease task = lease();
    if (task.kind() != v1::TASK_KIND_ERODE) {
      store_->complete(derive_header(task.token(), "s", 1), "s");
      break;
    }
    finish_block(task);
  }
  EXPECT_EQ(store_->job(half.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_TRUE(field(half.id()) == expected_field(300, 64));
}

TEST_F(BackupTest, OfADatabaseThatNobodyHasOpen) {
  const v1::Job job = complete_job(300, 40);
  store_.reset();
  take();
  EXPECT_EQ(restore()->job(job.id()).state(), v1::JOB_STATE_DONE);
}

// The copy is what the database was at one moment, and is not begun anew by every commit.
TEST_F(BackupTest, ShowsOneMomentWhileOthersWrite) {
  const v1::Job before = submit();
  int asked = 0;
  const Backup backup = take({false, [&] {
                                submit("OFF 2", "later " + std::to_string(asked++));
                                return true;
                              }});
  EXPECT_TRUE(backup.complete);
  EXPECT_GT(asked, 0);
  EXPECT_EQ(restore()->list({}).jobs.size(), 1U);
  EXPECT_EQ(store_->list({}).jobs.size(), static_cast<std::size_t>(asked) + 1);
}

TEST_F(BackupTest, BrokenOffItLeavesNothing) {
  EXPECT_FALSE(take({false, [] { return false; }}).complete);
  EXPECT_TRUE(files_elsewhere().empty());
}

TEST_F(BackupTest, ReplacesOnlyByForce) {
  std::ofstream(target()) << "precious";
  EXPECT_EQ(refused_with(target()), EEXIST);
  EXPECT_EQ(fs::file_size(target()), 8U);
  EXPECT_TRUE(take({true}).complete);
  EXPECT_NO_THROW(restore());
}

// As when two backups of one name are made at once.
TEST_F(BackupTest, KeepsAFileThatAppearsMeanwhile) {
  const auto appear = [&] {
    std::ofstream(target()) << "precious";
    return true;
  };
  EXPECT_THROW(take({false, appear}), std::system_error);
  EXPECT_EQ(fs::file_size(target()), 8U);
  EXPECT_EQ(files_elsewhere(), (std::vector<std::string>{"copy.db"}));
}

TEST_F(BackupTest, FollowsALink) {
  std::ofstream(elsewhere_.path() / "real.db") << "old";
  fs::create_symlink("real.db", target());
  EXPECT_EQ(refused_with(target()), EEXIST);
  EXPECT_TRUE(take({true}).complete);
  EXPECT_TRUE(fs::is_symlink(target()));
  EXPECT_NO_THROW(restore());
}

TEST_F(BackupTest, DoesNotReplaceWhatThisUserMayNotWrite) {
  std::ofstream(target()) << "old";
  fs::permissions(target(), fs::perms(0444));
  fs::permissions(elsewhere_.path(), fs::perms(0777));
  fs::permissions(directory_.path(), fs::perms(0777));
  for (const auto& entry : fs::directory_iterator(directory_.path())) fs::permissions(entry, fs::perms(0666));
  const uid_t before = geteuid();
  ASSERT_EQ(before == 0 ? seteuid(65534) : 0, 0) << "root may write everything";
  EXPECT_EQ(refused_with(target(), {true}), EACCES);
  ASSERT_EQ(seteuid(before), 0);
  EXPECT_EQ(files_elsewhere(), (std::vector<std::string>{"copy.db"}));
}

TEST_F(BackupTest, RefusesPlacesThatCannotBeWritten) {
  EXPECT_EQ(refused_with((elsewhere_.path() / "missing" / "copy.db").string()), ENOENT);
  EXPECT_EQ(refused_with(elsewhere_.path().string(), {true}), EISDIR);
  EXPECT_STORE_ERROR(back_up(directory_.path(), "/dev/null", {true}), kInvalid);
  EXPECT_STORE_ERROR(back_up(directory_.path(), "/dev/null"), kInvalid);
  EXPECT_STORE_ERROR(back_up(directory_.path(), "-"), kInvalid);
  fs::create_directories(fs::path(directory_.path()) / "a/b");
  EXPECT_STORE_ERROR(back_up(directory_.path(), fs::path(directory_.path()) / "a/b/copy.db"), kInvalid);
}

TEST_F(BackupTest, NeverWritesIntoTheDataDirectory) {
  complete_job(300, 40);
  const auto bytes = fs::file_size(database());
  EXPECT_STORE_ERROR(back_up(directory_.path(), database(), {true}), kInvalid);
  EXPECT_STORE_ERROR(back_up(directory_.path(), (directory_.path() / "copy.db").string()), kInvalid);
  fs::create_symlink(database(), target());
  EXPECT_STORE_ERROR(take({true}), kInvalid);
  EXPECT_EQ(fs::file_size(database()), bytes);
}

TEST_F(BackupTest, RefusesALogThatAnotherDatabaseHasLeft) {
  std::ofstream(target() + "-wal") << "frames";
  EXPECT_STORE_ERROR(take(), kInvalid);
  fs::remove(target() + "-wal");
  EXPECT_TRUE(take().complete);
}

TEST_F(BackupTest, AFullDiskIsToldAndLeavesNothing) {
  complete_job(5000, 40);
  SmallDisk disk(elsewhere_.path().string());
  disk.leave(100000);
  try {
    take();
    FAIL() << "there was no room";
  } catch (const SqliteError& error) {
    EXPECT_EQ(error.primary_code(), SQLITE_FULL);
    EXPECT_NE(std::string(error.what()).find(elsewhere_.path().string()), std::string::npos) << error.what();
  }
  EXPECT_TRUE(files_elsewhere().empty());
}

TEST_F(BackupTest, RefusesWhatIsNoDatabaseOfOurs) {
  const TemporaryDirectory other;
  EXPECT_STORE_ERROR(back_up(other.path(), target()), kUnusable);
  {
    Database db((other.path() / "affskel.db").string(), Database::Mode::kReadWrite);
    db.execute("CREATE TABLE t (x INTEGER)");
  }
  EXPECT_STORE_ERROR(back_up(other.path(), target()), kUnusable);
  EXPECT_TRUE(files_elsewhere().empty());
}

}  // namespace
}  // namespace affskel::server
