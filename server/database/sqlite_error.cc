#include "database/sqlite_error.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace affskel::server {
namespace {

std::string name_of(sqlite3* db) {
  const char* name = sqlite3_db_filename(db, "main");
  return name == nullptr ? "" : name;
}

bool means_no_room(int cause) {
  return cause == ENOSPC || cause == EDQUOT;
}

/// The error code.  SQLite reports a full quota, and a full disk while it writes the log's index, as I/O
/// errors, and a log that cannot be made for want of an inode without its cause: they become SQLITE_FULL.
int code_of(sqlite3* db) {
  const int code = sqlite3_extended_errcode(db);
  const int primary = code & 0xff;
  const int cause = sqlite3_system_errno(db);
  if (primary != SQLITE_IOERR && primary != SQLITE_CANTOPEN) return code;
  if (means_no_room(cause)) return SQLITE_FULL;
  const bool tells = primary == SQLITE_IOERR || cause == EMFILE || cause == ENFILE;
  const std::string file = name_of(db);
  return !tells && !file.empty() && means_no_room(probe_disk(file)) ? SQLITE_FULL : code;
}

bool failed_reading(int code) {
  return code == SQLITE_IOERR_READ || code == SQLITE_IOERR_SHORT_READ || code == SQLITE_IOERR_CORRUPTFS;
}

/// The message of an error.  Failures of the disk name file and cause, for users; all others are for
/// developers.
std::string describe(sqlite3* db, int code, int cause, const std::string& context) {
  if (db == nullptr) return "database " + context + ": out of memory";
  const int primary = code & 0xff;
  const std::string name = name_of(db), file = name.empty() ? context : name;
  if (primary == SQLITE_IOERR) {
    const std::string why = cause != 0 ? std::strerror(cause) : sqlite3_errmsg(db);
    return "database " + file + (failed_reading(code) ? ": cannot be read: " : ": cannot be written: ") + why;
  }
  if (code == SQLITE_FULL) return "database " + file + ": no room on the disk (space or inodes)";
  if (primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB) {
    return "database " + file + ": is damaged (" + sqlite3_errmsg(db) + "): " + kDamagedAdvice;
  }
  return "database " + context + ": " + sqlite3_errmsg(db) + " (code " + std::to_string(code) + ")";
}

}  // namespace

int probe_disk(const std::string& file) {
  const std::string probe = file + ".probe";
  unlink(probe.c_str());  // of a process that was killed here
  const int fd = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) return errno;
  const int error = posix_fallocate(fd, 0, kPageBytes);
  close(fd);
  unlink(probe.c_str());
  return error;
}

void raise_sqlite_error(sqlite3* db, const std::string& context) {
  const int code = db == nullptr ? SQLITE_NOMEM : code_of(db);
  const int primary = code & 0xff;
  const int cause = db == nullptr ? 0 : sqlite3_system_errno(db);
  const std::string message = describe(db, code, cause, context);
  if ((primary == SQLITE_CANTOPEN || primary == SQLITE_IOERR) && (cause == EMFILE || cause == ENFILE)) {
    throw OutOfFiles(code, message);
  }
  throw SqliteError(code, message);
}

bool SqliteError::blames_the_file() const {
  switch (primary_code()) {
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return true;
    default:
      return false;
  }
}

bool SqliteError::says_damaged() const {
  return primary_code() == SQLITE_NOTADB || primary_code() == SQLITE_CORRUPT ||
         failed_reading(extended_code_);
}

bool SqliteError::says_device() const {
  return (primary_code() == SQLITE_IOERR && !says_damaged()) || primary_code() == SQLITE_READONLY ||
         primary_code() == SQLITE_CANTOPEN;
}

}  // namespace affskel::server
