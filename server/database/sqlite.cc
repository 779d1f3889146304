#include "database/sqlite.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "database/checksum.h"

namespace affskel::server {
namespace {

// Long enough for another process (a backup, a shell) to finish what it does with the file.
constexpr int kBusyTimeoutMs = 10000;

// Reports rewrite field pages over and over: a long log copies each page to the database less often.
constexpr std::int64_t kJournalBytes = std::int64_t{64} << 20;

// Cache of a connection that only reads.  Small, for there may be many, and slow clients keep them open.
constexpr int kReaderCacheKib = 256;

// Pages copied between two questions whether to go on.
constexpr int kPagesCopied = 1024;

// The database file grows in steps of this size.
constexpr int kGrowthBytes = 1 << 20;

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
  if (code != SQLITE_OK)
    raise_sqlite_error(sqlite3_db_handle(handle_), std::string("statement ") + sqlite3_sql(handle_));
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
void Statement::bind_integer(int index, std::int64_t value) {
  check(sqlite3_bind_int64(handle_, index, value));
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  raise_sqlite_error(sqlite3_db_handle(handle_), std::string("statement ") + sqlite3_sql(handle_));
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
  const int access = mode == Mode::kReadWrite   ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                     : mode == Mode::kQueryOnly ? SQLITE_OPEN_READWRITE
                                                : SQLITE_OPEN_READONLY;
  try {
    if (sqlite3_open_v2(file.c_str(), &handle_, access | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
                        nullptr) != SQLITE_OK) {
      raise_sqlite_error(handle_, file);
    }
    sqlite3_extended_result_codes(handle_, 1);
    if (register_checksum(handle_) != SQLITE_OK) raise_sqlite_error(handle_, file_);
    sqlite3_busy_timeout(handle_, kBusyTimeoutMs);
    execute("PRAGMA foreign_keys = ON");
    prepare_rollback();
    if (mode == Mode::kReadWrite) {
      set_up_writing();
    } else {
      set_up_reading();
    }
  } catch (...) {
    close();
    throw;
  }
}

void Database::set_up_reading() {
  // Otherwise the last connection to close would copy the log into the file.
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  // Readers go through what they read once.
  execute("PRAGMA query_only = ON; PRAGMA cache_size = " + std::to_string(-kReaderCacheKib));
}

void Database::set_up_writing() {
  // FULL: a commit is on the disk when it is acknowledged.
  // Secure deletion, which Debian switches on, writes every page that is freed: a delete would need as
  // much room in the log as it is to make.
  // Temporary files may lie on another disk, which would be taken for this one when it is full.
  // Given to a file that is there already, the first two would do nothing, or write for nothing.
  if (integer("PRAGMA page_count") == 0) {
    execute("PRAGMA page_size = " + std::to_string(kPageBytes) + "; PRAGMA auto_vacuum = INCREMENTAL");
  }
  execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA journal_size_limit = " +
          std::to_string(kJournalBytes) +
          "; PRAGMA cache_size = -8192; PRAGMA trusted_schema = OFF; PRAGMA secure_delete = OFF"
          "; PRAGMA temp_store = MEMORY");
  int step = kGrowthBytes;
  sqlite3_file_control(handle_, "main", SQLITE_FCNTL_CHUNK_SIZE, &step);
  set_usual_log_limit();
}

Database::~Database() {
  close();
}

void Database::close() noexcept {
  cache_.clear();
  sqlite3_finalize(std::exchange(rollback_, nullptr));
  sqlite3_close_v2(handle_);
  handle_ = nullptr;
}

sqlite3_stmt* Database::compile(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v3(handle_, sql, -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr) != SQLITE_OK) {
    raise_sqlite_error(handle_, file_ + ": statement " + sql);
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

void Database::prepare_rollback() {
  rollback_ = compile("ROLLBACK");
}

void Database::roll_back() noexcept {
  // SQLite may have done so by itself (disk full, no memory); a second ROLLBACK would only report that.
  if (sqlite3_get_autocommit(handle_) != 0) return;
  sqlite3_step(rollback_);
  sqlite3_reset(rollback_);
}

bool Database::is_at_rest() const {
  if (sqlite3_get_autocommit(handle_) == 0) return false;
  for (sqlite3_stmt* one = nullptr; (one = sqlite3_next_stmt(handle_, one)) != nullptr;) {
    if (sqlite3_stmt_busy(one) != 0) return false;
  }
  return true;
}

/// In whole steps.  SQLite's own way, SQLITE_FCNTL_SIZE_HINT, is a call of the system for every block of the disk.
bool Database::grow_to(std::int64_t bytes) {
  static const std::array<char, 65536> kZeros{};  // SQLite writes less than 128 KiB at a time
  sqlite3_file* file = nullptr;
  sqlite3_int64 size = 0;
  if (sqlite3_file_control(handle_, "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK ||
      file->pMethods->xFileSize(file, &size) != SQLITE_OK) {
    return false;
  }
  const sqlite3_int64 end = (bytes + kGrowthBytes - 1) / kGrowthBytes * kGrowthBytes;
  for (sqlite3_int64 step = 0; size < end; size += step) {
    step = std::min<sqlite3_int64>(kZeros.size(), end - size);
    if (file->pMethods->xWrite(file, kZeros.data(), static_cast<int>(step), size) != SQLITE_OK) return false;
  }
  return true;
}

void Database::claim_pages() {
  const sqlite3_int64 bytes =
      integer("PRAGMA page_count").value_or(0) * integer("PRAGMA page_size").value_or(kPageBytes);
  if (!grow_to(bytes)) {
    // SQLite does not say why.
    if (const int why = probe_disk(file_); why == EROFS || why == EIO) {
      throw SqliteError(SQLITE_IOERR_WRITE,
                        "database " + file_ + ": cannot be written: " + std::strerror(why));
    }
    throw SqliteError(SQLITE_FULL, "database " + file_ + ": no room for " + std::to_string(bytes) + " bytes");
  }
}

void Database::unclaim_pages() {
  // A checkpoint shortens the file only when the log holds something: so the first page is written unchanged.
  execute("PRAGMA user_version = " + std::to_string(integer("PRAGMA user_version").value_or(0)));
  checkpoint();
}

bool Database::checkpoint() {
  sqlite3_busy_timeout(handle_, 0);
  const int code = sqlite3_wal_checkpoint_v2(handle_, "main", SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
  sqlite3_busy_timeout(handle_, kBusyTimeoutMs);
  if (code != SQLITE_OK && (code & 0xff) != SQLITE_BUSY) raise_sqlite_error(handle_, file_);
  return code == SQLITE_OK;
}

void Database::set_log_limit(std::int64_t bytes) {
  sqlite3_wal_autocheckpoint(handle_,
                             static_cast<int>(bytes / integer("PRAGMA page_size").value_or(kPageBytes)));
}

void Database::set_usual_log_limit() {
  set_log_limit(kJournalBytes);
}

namespace {

/// A file that is only written, from its first page to its last: a journal would be of no use.
class CopyTarget {
 public:
  CopyTarget(const std::string& file, const std::string& context) : context_(context) {
    const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
    const char* settings = "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF";
    if (sqlite3_open_v2(file.c_str(), &handle_, flags, nullptr) == SQLITE_OK &&
        sqlite3_exec(handle_, settings, nullptr, nullptr, nullptr) == SQLITE_OK) {
      return;
    }
    const Closer closer{handle_};
    raise_sqlite_error(handle_, context_);
  }
  ~CopyTarget() { sqlite3_close_v2(handle_); }
  CopyTarget(const CopyTarget&) = delete;
  CopyTarget& operator=(const CopyTarget&) = delete;

  bool fill_from(sqlite3* source, const std::function<bool()>& go_on) {
    sqlite3_backup* copy = sqlite3_backup_init(handle_, "main", source, "main");
    if (copy == nullptr) raise_sqlite_error(handle_, context_);
    int code = SQLITE_OK;
    while (code == SQLITE_OK && go_on()) code = sqlite3_backup_step(copy, kPagesCopied);
    // It leaves the error that a step met, if any, with the target.
    if (sqlite3_backup_finish(copy) != SQLITE_OK) raise_sqlite_error(handle_, context_);
    return code == SQLITE_DONE;
  }

 private:
  struct Closer {
    sqlite3* handle;
    ~Closer() { sqlite3_close_v2(handle); }
  };
  sqlite3* handle_ = nullptr;
  std::string context_;
};

}  // namespace

bool Database::copy_to(const std::string& file, const std::function<bool()>& go_on) {
  CopyTarget target(file, file_ + " to " + file);
  return target.fill_from(handle_, go_on);
}

void Database::execute(const std::string& script) {
  if (sqlite3_exec(handle_, script.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    raise_sqlite_error(handle_, file_);
}

Transaction::Transaction(Database& db, Kind kind) : db_(db) {
  db_.run(kind == Kind::kImmediate ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  if (open_) db_.roll_back();
}

void Transaction::commit() {
  db_.run("COMMIT");
  open_ = false;
}

BlobHandle::BlobHandle(Database& db, const char* table, const char* column, std::int64_t rowid) : db_(db) {
  check(sqlite3_blob_open(db.handle(), "main", table, column, rowid, 1, &handle_));
}

BlobHandle::~BlobHandle() {
  sqlite3_blob_close(handle_);
}

void BlobHandle::check(int code) const {
  if (code != SQLITE_OK) raise_sqlite_error(db_.handle(), db_.file() + ": blob");
}

void BlobHandle::read(void* to, int bytes, int offset) const {
  check(sqlite3_blob_read(handle_, to, bytes, offset));
}

void BlobHandle::write(const void* from, int bytes, int offset) {
  check(sqlite3_blob_write(handle_, from, bytes, offset));
}

}  // namespace affskel::server
