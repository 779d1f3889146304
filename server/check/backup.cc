#include "check/backup.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "base/directory.h"
#include "database/database_file.h"
#include "database/errors.h"
#include "database/migrate.h"
#include "database/sqlite.h"

namespace affskel::server {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(int error, const std::string& file) {
  throw std::system_error(error, std::generic_category(), "cannot write " + file);
}

void sync(const std::string& path, const std::string& about) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) fail(errno, about);
  const int error = fsync(fd) == 0 ? 0 : errno;
  close(fd);
  if (error != 0) fail(error, about);
}

/// A file beside the target that becomes it, or vanishes.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& target) : target_(target) {
    // Not after the target: its name may be as long as names can be.
    path_ = (base::directory_of(target) / ".affskel-backup.XXXXXX").string();
    const int fd = mkostemp(path_.data(), O_CLOEXEC);
    if (fd < 0) fail(errno, target_);
    close(fd);
  }
  ~TemporaryFile() {
    if (!path_.empty()) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

  void become_target(bool replace) {
    sync(path_, target_);
    if (!(replace ? rename(path_.c_str(), target_.c_str()) == 0 : rename_to_new())) fail(errno, target_);
    path_.clear();
    base::sync_directory(base::directory_of(target_));
  }

 private:
  // A file of that name that was made meanwhile is kept.
  bool rename_to_new() const {
    if (renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) return true;
    // Not every file system can do that.
    if (errno != EINVAL && errno != ENOSYS) return false;
    return link(path_.c_str(), target_.c_str()) == 0 && unlink(path_.c_str()) == 0;
  }

  std::string target_;
  std::string path_;
};

/// SQLite would read logs left by an earlier database of that name as part of the new one.
void refuse_left_logs(const std::string& target) {
  for (const char* suffix : {"-wal", "-journal"}) {
    std::error_code absent;
    const std::uintmax_t bytes = fs::file_size(target + suffix, absent);
    if (absent || bytes == 0) continue;
    throw StoreError(StoreError::Code::kInvalid, target + ": " + target + suffix +
                                                     " belongs to another database of that name; remove it");
  }
}

bool lies_in(const fs::path& file, const fs::path& directory) {
  std::error_code error;
  fs::path at = fs::weakly_canonical(base::directory_of(file), error);
  for (; !fs::equivalent(at, directory, error); at = at.parent_path()) {
    if (at == at.parent_path()) return false;
  }
  return true;
}

/// Where the backup goes: a symbolic link is followed.
std::string checked_target(const std::string& target, const std::string& data_dir, bool force) {
  std::error_code error;
  if (target == "-")
    throw StoreError(StoreError::Code::kInvalid, "a backup is a file, it cannot go to the standard output");
  const bool exists = fs::exists(fs::symlink_status(target, error));
  if (exists && fs::is_directory(target, error)) fail(EISDIR, target);
  if (exists && !fs::is_regular_file(target, error)) {
    throw StoreError(StoreError::Code::kInvalid, target + ": only a regular file is replaced");
  }
  if (exists && !force) fail(EEXIST, target);
  if (exists && faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) fail(errno, target);
  const fs::path path = exists ? fs::canonical(target) : fs::path(target);
  // It might be the database itself, or its log; and there it would be lost together with them.
  if (lies_in(path, data_dir)) {
    throw StoreError(StoreError::Code::kInvalid, target + ": a backup must not lie in the data directory");
  }
  refuse_left_logs(path.string());
  return path.string();
}

}  // namespace

// SQLite's backup interface copies pages as they are.  VACUUM INTO would leave out what is free, but sort and
// write every row anew, and it cannot be broken off or followed.  One read transaction holds the view:
// without it every commit of a running server would begin the copy anew.  Writers are not held up; the log
// alone cannot be emptied until the copy is done.
Backup back_up(const std::string& data_dir, const std::string& target, const BackupOptions& options) {
  Database db(existing_database_file(data_dir), Database::Mode::kReadOnly);
  const std::string path = checked_target(target, data_dir, options.force);
  const Transaction view(db, Transaction::Kind::kRead);
  Backup backup;
  backup.schema = checked_schema(db);
  TemporaryFile copy(path);
  if (!db.copy_to(copy.path(), options.go_on)) return backup;
  backup.bytes = static_cast<std::int64_t>(fs::file_size(copy.path()));
  copy.become_target(options.force);
  backup.complete = true;
  return backup;
}

}  // namespace affskel::server
