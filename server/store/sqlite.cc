#include "store/sqlite.h"

#include <utility>

namespace affskel::server {
namespace {

// Long enough for another process (a backup, a shell) to finish what it does with the file.
constexpr int kBusyTimeoutMs = 10000;

// Reports log megabytes of records, and every page of them costs several calls of the system; every small
// commit, on the other hand, logs the few pages that it touches whole.  A database keeps the size it was
// made with.
constexpr int kPageBytes = 16384;

// Reports rewrite field pages over and over: a long log copies each page to the database less often.
constexpr std::int64_t kJournalBytes = std::int64_t{64} << 20;

[[noreturn]] void raise(sqlite3* db, const std::string& context) {
  const int code = db == nullptr ? SQLITE_NOMEM : sqlite3_extended_errcode(db);
  const char* text = db == nullptr ? "out of memory" : sqlite3_errmsg(db);
  throw SqliteError(code, "database " + context + ": " + text + " (code " + std::to_string(code) + ")");
}

}  // namespace

struct Database::Cached {
  explicit Cached(sqlite3_stmt* handle) : statement(handle) {}
  ~Cached() { sqlite3_finalize(statement); }
  Cached(const Cached&) = delete;
  Cached& operator=(const Cached&) = delete;
  sqlite3_stmt* statement;
  bool busy = false;
};

Statement::Statement(Statement&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)), busy_(std::exchange(other.busy_, nullptr)) {}

Statement::~Statement() {
  if (handle_ == nullptr) return;
  if (busy_ == nullptr) {
    sqlite3_finalize(handle_);
    return;
  }
  sqlite3_reset(handle_);
  sqlite3_clear_bindings(handle_);
  *busy_ = false;
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) raise(sqlite3_db_handle(handle_), std::string("statement ") + sqlite3_sql(handle_));
}

void Statement::bind(int index, std::string_view text) {
  check(sqlite3_bind_text64(handle_, index, text.data() == nullptr ? "" : text.data(), text.size(),
                            SQLITE_TRANSIENT, SQLITE_UTF8));
}

void Statement::bind(int index, Blob blob) {
  if (blob.bytes.empty()) {
    check(sqlite3_bind_zeroblob(handle_, index, 0));
    return;
  }
  check(sqlite3_bind_blob64(handle_, index, blob.bytes.data(), blob.bytes.size(), SQLITE_STATIC));
}

void Statement::bind(int index, double value) {
  check(sqlite3_bind_double(handle_, index, value));
}
void Statement::bind(int index, std::nullptr_t) {
  check(sqlite3_bind_null(handle_, index));
}
void Statement::bind_integer(int index, std::int64_t value) {
  check(sqlite3_bind_int64(handle_, index, value));
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  raise(sqlite3_db_handle(handle_), std::string("statement ") + sqlite3_sql(handle_));
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_, column);
}
double Statement::real(int column) const {
  return sqlite3_column_double(handle_, column);
}

std::string Statement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  if (data == nullptr) return {};
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

std::string_view Statement::blob(int column) const {
  const auto* data = static_cast<const char*>(sqlite3_column_blob(handle_, column));
  if (data == nullptr) return {};
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(handle_, column) == SQLITE_NULL;
}

Database::Database(const std::string& file, Mode mode) : file_(file) {
  const int access =
      mode == Mode::kReadOnly ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  try {
    if (sqlite3_open_v2(file.c_str(), &handle_, access | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
                        nullptr) != SQLITE_OK) {
      raise(handle_, file);
    }
    sqlite3_extended_result_codes(handle_, 1);
    sqlite3_busy_timeout(handle_, kBusyTimeoutMs);
    execute("PRAGMA foreign_keys = ON");
    if (mode == Mode::kReadWrite) {
      // FULL: a commit is on the disk when it is acknowledged.
      execute("PRAGMA page_size = " + std::to_string(kPageBytes) +
              "; PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA journal_size_limit = " +
              std::to_string(kJournalBytes) + "; PRAGMA cache_size = -65536; PRAGMA trusted_schema = OFF");
      const std::int64_t page_bytes = integer("PRAGMA page_size").value_or(kPageBytes);
      execute("PRAGMA wal_autocheckpoint = " + std::to_string(kJournalBytes / page_bytes));
    }
  } catch (...) {
    close();
    throw;
  }
}

Database::~Database() {
  close();
}

void Database::close() noexcept {
  cache_.clear();
  sqlite3_close_v2(handle_);
  handle_ = nullptr;
}

sqlite3_stmt* Database::compile(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v3(handle_, sql, -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr) != SQLITE_OK) {
    raise(handle_, file_ + ": statement " + sql);
  }
  return statement;
}

Statement Database::prepare(const char* sql) {
  std::unique_ptr<Cached>& slot = cache_[sql];
  if (!slot) slot = std::make_unique<Cached>(compile(sql));
  if (slot->busy) return {compile(sql), nullptr};
  slot->busy = true;
  return {slot->statement, &slot->busy};
}

void Database::execute(const std::string& script) {
  if (sqlite3_exec(handle_, script.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) raise(handle_, file_);
}

Transaction::Transaction(Database& db, Kind kind) : db_(db) {
  db_.execute(kind == Kind::kImmediate ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  // SQLite may have rolled back by itself (disk full); a second ROLLBACK would only report that.
  if (open_ && sqlite3_get_autocommit(db_.handle()) == 0) {
    sqlite3_exec(db_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

void Transaction::commit() {
  db_.execute("COMMIT");
  open_ = false;
}

BlobHandle::BlobHandle(Database& db, const char* table, const char* column, std::int64_t rowid) : db_(db) {
  check(sqlite3_blob_open(db.handle(), "main", table, column, rowid, 1, &handle_));
}

BlobHandle::~BlobHandle() {
  sqlite3_blob_close(handle_);
}

void BlobHandle::check(int code) const {
  if (code != SQLITE_OK) raise(db_.handle(), db_.file() + ": blob");
}

void BlobHandle::reopen(std::int64_t rowid) {
  check(sqlite3_blob_reopen(handle_, rowid));
}
void BlobHandle::read(void* to, int bytes, int offset) const {
  check(sqlite3_blob_read(handle_, to, bytes, offset));
}
void BlobHandle::write(const void* from, int bytes, int offset) {
  check(sqlite3_blob_write(handle_, from, bytes, offset));
}

}  // namespace affskel::server
