#include "database/database_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "base/directory.h"
#include "base/regular_file.h"
#include "database/errors.h"
#include "database/migrate.h"
#include "database/sqlite.h"

namespace affskel::server {
namespace {

// A file of one byte is empty for SQLite; this is what its header has.
constexpr off_t kHeaderBytes = 100;

[[noreturn]] void refuse(const std::string& why) {
  throw StoreError(StoreError::Code::kUnusable, why);
}

std::string mark_of(const std::string& file) {
  return (base::directory_of(file) / "affskel.made").string();
}

bool has_bytes(const std::string& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 && status.st_size > 0;
}

/// SQLite would wait for ever for a process to write into a FIFO.
void refuse_irregular(const std::string& database) {
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
    const std::string file = database + suffix;
    if (const char* kind = base::kind_unless_regular(file)) refuse(file + ": " + kind + ", no database");
  }
}

/// False when it is not there.  @throws when it is, and is no database at all.
bool is_there(const std::string& file) {
  refuse_irregular(file);
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return false;
    throw std::system_error(errno, std::generic_category(), file);
  }
  // SQLite would take it for a new database, and delete the log beside it as left over.
  if (status.st_size < kHeaderBytes) {
    refuse(file + ": no database, the file " +
           (status.st_size == 0 ? "is empty" : "has " + std::to_string(status.st_size) + " bytes") +
           "; restore a backup, or remove it to begin with an empty one");
  }
  return true;
}

void refuse_lost(const std::string& file) {
  const std::string mark = mark_of(file);
  const bool made = access(mark.c_str(), F_OK) == 0;
  if (!made && !has_bytes(file + "-wal")) return;
  refuse(file + ": the database is missing, " + (made ? mark : file + "-wal") +
         " says that there was one; restore it or a backup of it, or remove " +
         (made ? mark : file + "-wal") + " to begin with an empty one");
}

void refuse_foreign(const std::string& file) {
  Database db(file, Database::Mode::kReadOnly);
  if (checked_schema(db) == 0) {
    refuse(file +
           ": there is nothing in this database; restore a backup, or remove it to begin with an"
           " empty one");
  }
}

void remove_with_logs(const std::string& file) {
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) unlink((file + suffix).c_str());
}

/// SQLite does not tell why it could not make a file.
void make_empty(const std::string& file) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) throw std::system_error(errno, std::generic_category(), "database " + file);
  close(fd);
}

void make_database(const std::string& file) {
  const std::string unfinished = file + ".new";
  remove_with_logs(unfinished);
  make_empty(unfinished);
  try {
    Database db(unfinished, Database::Mode::kReadWrite);
    migrate(db);
    db.checkpoint();
  } catch (...) {
    remove_with_logs(unfinished);
    throw;
  }
  if (rename(unfinished.c_str(), file.c_str()) != 0)
    throw std::system_error(errno, std::generic_category(), file);
  base::sync_directory(base::directory_of(file));
}

/// Only after the database is there: a mark without one would lock its own directory.  On a full disk it is
/// left to the next start.
void make_mark(const std::string& file) {
  const std::string mark = mark_of(file);
  if (access(mark.c_str(), F_OK) == 0) return;
  std::ofstream out(mark);
  out << "affskel.db belongs in this directory; when it is missing, affskel-server does not start, lest it\n"
         "begin with an empty one.  To begin anew on purpose, remove this file, too.\n";
  out.close();
  base::sync_directory(base::directory_of(file));
}

}  // namespace

std::string existing_database_file(const std::string& data_dir) {
  std::string file = database_file(data_dir);
  if (is_there(file)) return file;
  refuse(data_dir + ": no data directory of affskel-server, there is no affskel.db in it");
}

const std::string& ready_database_file(const std::string& file) {
  if (is_there(file)) {
    refuse_foreign(file);
  } else {
    refuse_lost(file);
    make_database(file);
  }
  make_mark(file);
  return file;
}

std::string file_identity(const std::string& file) {
  struct statx status {};
  if (statx(AT_FDCWD, file.c_str(), 0, STATX_INO | STATX_BTIME, &status) != 0) return {};
  std::string identity = std::to_string(status.stx_ino);
  if ((status.stx_mask & STATX_BTIME) != 0) {
    identity +=
        "@" + std::to_string(status.stx_btime.tv_sec) + "." + std::to_string(status.stx_btime.tv_nsec);
  }
  return identity;
}

OpenFile::Seen OpenFile::see(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {path};
  return {path, status.st_dev, status.st_ino};
}

OpenFile::OpenFile(const std::string& database) : database_(see(database)), log_(see(database + "-wal")) {}

bool OpenFile::replaced() const {
  const auto other = [](const Seen& seen) {
    if (seen.number == 0) return false;
    const Seen now = see(seen.path);
    return now.device != seen.device || now.number != seen.number;
  };
  return other(database_) || other(log_);
}

}  // namespace affskel::server
