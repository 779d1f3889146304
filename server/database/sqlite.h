#pragma once

#include <sqlite3.h>

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "database/sqlite_error.h"

namespace affskel::server {

/// Bytes to bind as a BLOB; text is bound as TEXT.
struct Blob {
  std::string_view bytes;
};

/// A prepared statement on loan from its database's cache; given back, reset, on destruction.
class Statement {
 public:
  Statement(sqlite3_stmt* handle, bool* busy) : handle_(handle), busy_(busy) {}
  Statement(Statement&& other) noexcept;
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  ~Statement();

  /// Binds parameter `index` (from 1).  Text is copied; the bytes of a Blob must live until the statement
  /// is given back.
  void bind(int index, std::string_view text);
  void bind(int index, const std::string& text) { bind(index, std::string_view(text)); }
  void bind(int index, const char* text) { bind(index, std::string_view(text)); }
  void bind(int index, Blob blob);
  void bind(int index, double value);
  void bind(int index, std::integral auto value) { bind_integer(index, static_cast<std::int64_t>(value)); }
  template <typename T>
  void bind(int index, const std::optional<T>& value) {
    if (value) bind(index, *value);  // unbound is NULL
  }

  /// Runs to the next row; false at the end.
  bool step();

  /// Values of the current row, columns from 0.
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  /// Bytes that live until the next step.
  std::string_view blob(int column) const;
  bool is_null(int column) const;
  bool flag(int column) const { return integer(column) != 0; }

 private:
  void bind_integer(int index, std::int64_t value);
  void check(int code) const;

  sqlite3_stmt* handle_;
  bool* busy_;  // the cache's mark; null when the statement is this object's own
};

/// The columns of the current row, taken in the order in which the SELECT names them: an added column is one
/// more line at its place, and no number changes.
class Columns {
 public:
  /// @param row must outlive it, and stay at its row.
  explicit Columns(const Statement& row) : row_(row) {}

  std::int64_t integer() { return row_.integer(next_++); }
  std::uint64_t natural() { return static_cast<std::uint64_t>(integer()); }
  double real() { return row_.real(next_++); }
  std::string text() { return row_.text(next_++); }
  std::string_view blob() { return row_.blob(next_++); }
  bool flag() { return integer() != 0; }
  /// Empty for NULL.
  std::optional<std::int64_t> integer_or_null() {
    const bool null = row_.is_null(next_);
    const std::int64_t value = integer();
    return null ? std::nullopt : std::optional(value);
  }
  std::optional<std::string> text_or_null() {
    const bool null = row_.is_null(next_);
    std::string value = text();
    return null ? std::nullopt : std::optional(std::move(value));
  }
  std::optional<std::string_view> blob_or_null() {
    const bool null = row_.is_null(next_);
    const std::string_view value = blob();
    return null ? std::nullopt : std::optional(value);
  }

 private:
  const Statement& row_;
  int next_ = 0;
};

/// One connection.  Not thread-safe: its user holds a lock.
class Database {
 public:
  enum class Mode {
    kReadWrite,
    kReadOnly,
    kQueryOnly,  ///< for checking: SQLite does not know the CHECK constraints of files that are read-only
  };

  /// Opens (and creates, when read-write) a file in WAL mode with full synchronisation and foreign keys.
  /// Otherwise nothing is written to it or its log.
  /// @throws SqliteError naming the file.
  Database(const std::string& file, Mode mode);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// A statement with its parameters bound in order.
  template <typename... Args>
  Statement query(const char* sql, const Args&... args) {
    Statement statement = prepare(sql);
    [[maybe_unused]] int index = 0;
    (statement.bind(++index, args), ...);
    return statement;
  }

  /// Runs a statement to its end; returns the number of rows it changed.
  template <typename... Args>
  std::int64_t run(const char* sql, const Args&... args) {
    Statement statement = query(sql, args...);
    while (statement.step()) {
    }
    return sqlite3_changes64(handle_);
  }

  /// First column of the first row as an integer; nothing when there is no row or it is NULL.
  template <typename... Args>
  std::optional<std::int64_t> integer(const char* sql, const Args&... args) {
    Statement statement = query(sql, args...);
    if (!statement.step() || statement.is_null(0)) return std::nullopt;
    return statement.integer(0);
  }

  /// Sees to it that the database file has room for every page that the open transaction has added, so that
  /// a checkpoint needs no more of the disk than the file has already: what is committed never waits in the
  /// log for room elsewhere.  @throws SqliteError with SQLITE_FULL when there is none.
  void claim_pages();

  /// Gives back what claim_pages took for a transaction that was not committed after all, and shortens the
  /// log.
  void unclaim_pages();

  /// Copies the log into the database file and shortens both; false when a reader is in the way.  Does not
  /// wait.  Outside of a transaction.
  bool checkpoint();

  /// Copies the log into the file after each commit that leaves more than this in it.
  void set_log_limit(std::int64_t bytes);
  void set_usual_log_limit();

  /// Copies the database, page by page and as the open transaction sees it, to `file`, which must be there
  /// and empty.  Does not sync it.
  /// @param go_on asked every few megabytes; false breaks off.  @returns whether all was copied.
  /// @throws SqliteError naming both files.
  bool copy_to(const std::string& file, const std::function<bool()>& go_on);

  /// Runs a script of statements without parameters.
  void execute(const std::string& script);

  /// Ends a transaction that is still open, changing nothing; needs no memory that is not there already.
  void roll_back() noexcept;

  /// Whether neither a transaction nor a statement is open, so that the next one sees what is newest.
  bool is_at_rest() const;

  std::int64_t last_insert_rowid() const { return sqlite3_last_insert_rowid(handle_); }
  sqlite3* handle() const { return handle_; }
  const std::string& file() const { return file_; }

 private:
  struct Cached;
  Statement prepare(const char* sql);
  sqlite3_stmt* compile(const char* sql);
  void set_up_reading();
  void prepare_rollback();
  void set_up_writing();
  bool grow_to(std::int64_t bytes);
  void close() noexcept;

  std::string file_;
  sqlite3* handle_ = nullptr;
  sqlite3_stmt* rollback_ = nullptr;
  std::unordered_map<std::string, std::unique_ptr<Cached>> cache_;
};

/// A transaction that rolls back unless committed.
class Transaction {
 public:
  enum class Kind { kImmediate, kRead };
  explicit Transaction(Database& db, Kind kind = Kind::kImmediate);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& db_;
  bool open_ = true;
};

/// In-place access to one BLOB cell of an open transaction.
class BlobHandle {
 public:
  BlobHandle(Database& db, const char* table, const char* column, std::int64_t rowid);
  ~BlobHandle();
  BlobHandle(const BlobHandle&) = delete;
  BlobHandle& operator=(const BlobHandle&) = delete;

  int size() const { return sqlite3_blob_bytes(handle_); }
  void read(void* to, int bytes, int offset) const;
  void write(const void* from, int bytes, int offset);

 private:
  void check(int code) const;

  Database& db_;
  sqlite3_blob* handle_ = nullptr;
};

}  // namespace affskel::server
