#pragma once

#include <sqlite3.h>

#include <stdexcept>
#include <string>

namespace affskel::server {

/// Bytes of a page.  Reports log megabytes of records, and every page of them costs several calls of the system; every
/// small commit, on the other hand, logs the few pages that it touches whole.  A database keeps the size it was made
/// with.
inline constexpr int kPageBytes = 16384;

/// Where the message of a damaged file ends.
inline constexpr const char* kDamagedAdvice =
    "stop the server and run affskel-server check --repair, or restore a backup";

/// An error of SQLite itself: a bug, a damaged file or a full disk.
class SqliteError : public std::runtime_error {
 public:
  SqliteError(int extended_code, const std::string& message)
      : std::runtime_error(message), extended_code_(extended_code) {}
  int extended_code() const { return extended_code_; }
  int primary_code() const { return extended_code_ & 0xff; }
  /// The file is damaged, foreign or closed to us: no bug of this program.
  bool blames_the_file() const;
  /// Bytes of it cannot be read, or are not what a database has there.
  bool says_damaged() const;
  /// The device failed a write or cannot be written: what was asked for may be asked again.
  bool says_device() const;

 private:
  int extended_code_;
};

/// The process or the machine has no descriptor left for the database's files: it soon has again.
class OutOfFiles : public SqliteError {
 public:
  using SqliteError::SqliteError;
};

/// The error of making a small file beside this one; 0 when that works.  The file itself must not be opened:
/// closing it would release SQLite's locks.
int probe_disk(const std::string& file);

/// Throws what the last call on this connection came to; a null pointer stands for one that could not be made.
/// @param context for developers: the statement, or the file.
[[noreturn]] void raise_sqlite_error(sqlite3* db, const std::string& context);

}  // namespace affskel::server
