#include "process/token_command.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "access/token.h"
#include "base/quoted.h"
#include "base/standard_streams.h"
#include "database/database_file.h"
#include "database/errors.h"
#include "database/migrate.h"
#include "database/sqlite.h"
#include "process/data_dir.h"
#include "store/clock.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

using Json = nlohmann::ordered_json;

/// A schema of before has the same tokens: bringing it up to date, which cannot be undone, is left to `migrate`.
/// @throws StoreError kUnusable where it has not.
void require_tokens(Database& db) {
  constexpr std::int64_t kColumns = 8;
  checked_schema(db);
  if (db.integer("SELECT count(*) FROM pragma_table_info('tokens')") == kColumns) return;
  throw StoreError(StoreError::Code::kUnusable,
                   db.file() +
                       ": has no tokens that this program knows; make a backup, and run"
                       " affskel-server migrate first");
}

/// The database of a data directory, held against a server for as long as a command writes to it.
class TokenDatabase {
 public:
  /// @param make where there is none yet.
  TokenDatabase(const std::string& data_dir, bool make) {
    const bool served = data_dir_holder(data_dir).has_value();
    if (served || !make) existing_database_file(data_dir);
    if (!served) {
      umask(0077);  // as the server itself
      held_.emplace(data_dir);
      ready_database_file(database_file(held_->path()));
    }
    db_ = std::make_unique<Database>(database_file(data_dir), Database::Mode::kReadWrite);
    require_tokens(*db_);
  }

  Database& operator*() { return *db_; }

 private:
  std::optional<DataDir> held_;
  std::unique_ptr<Database> db_;
};

/// Unix milliseconds as people write it, in UTC.
std::string time_text(const std::optional<std::int64_t>& ms, const char* absent) {
  if (!ms) return absent;
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(*ms / 1000)));
}

const char* state_of(const TokenRow& token, std::int64_t now_ms) {
  return token.revoked_ms ? "revoked" : token.is_expired(now_ms) ? "expired" : "good";
}

Json json_of(const TokenRow& token, std::int64_t now_ms) {
  const auto time = [](const std::optional<std::int64_t>& ms) { return ms ? Json(*ms) : Json(); };
  return {{"id", token.id},
          {"owner", token.owner},
          {"role", wire::word(token.role)},
          {"state", state_of(token, now_ms)},
          {"created_ms", token.created_ms},
          {"expires_ms", time(token.expires_ms)},
          {"revoked_ms", time(token.revoked_ms)},
          {"last_used_ms", time(token.last_used_ms)}};
}

/// A new file with a token, written before the token counts, so that none is lost; gone again unless it is kept.
class TokenFile {
 public:
  /// @throws StoreError kInvalid when it exists, std::system_error when it cannot be written.
  TokenFile(const std::string& path, const std::string& token) : path_(path) {
    const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (fd < 0 && errno == EEXIST)
      throw StoreError(StoreError::Code::kInvalid, path_ + " exists already: a token gets a file of its own");
    if (fd < 0) fail("cannot make");
    const std::string line = token + "\n";
    const bool written =
        write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size()) && fsync(fd) == 0;
    if (close(fd) == 0 && written) return;
    unlink(path_.c_str());
    fail("cannot write");
  }
  TokenFile(const TokenFile&) = delete;
  TokenFile& operator=(const TokenFile&) = delete;
  ~TokenFile() {
    if (!kept_) unlink(path_.c_str());
  }
  void keep() { kept_ = true; }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw std::system_error(errno, std::generic_category(), std::string(what) + " the token's file " + path_);
  }

  std::string path_;
  bool kept_ = false;
};

/// @throws StoreError kInvalid when the output goes to a file that others may read, as one made by `>` mostly is.
void require_private_output() {
  struct stat about {};
  if (fstat(STDOUT_FILENO, &about) != 0 || !S_ISREG(about.st_mode)) return;
  if ((about.st_mode & (S_IRGRP | S_IROTH)) != 0)
    throw StoreError(StoreError::Code::kInvalid,
                     "the output is a file that others may read; -o FILE makes one for you alone");
}

}  // namespace

base::ExitCode add_token_command(const Options& options, const Console& console) {
  if (options.output.empty()) require_private_output();
  TokenDatabase db(options.data_dir, true);
  const std::string token = new_token();
  std::optional<TokenFile> file;
  if (!options.output.empty()) file.emplace(options.output, token);
  const std::int64_t now = unix_ms();
  std::optional<std::int64_t> expires;
  if (options.expires) expires = now + std::chrono::milliseconds(*options.expires).count();
  const std::int64_t id = add_token(*db, token, options.owner, options.role, now, expires);
  try {
    if (console.json()) {
      console.result({{"token", file ? Json() : Json(token)},
                      {"id", id},
                      {"owner", options.owner},
                      {"role", wire::word(options.role)},
                      {"expires_ms", expires ? Json(*expires) : Json()}});
    } else if (!file) {
      console.print(token + "\n");
    }
  } catch (const base::OutputError&) {
    remove_token(*db, id);  // nobody saw it
    throw;
  }
  if (file) file->keep();
  console.note("token " + std::to_string(id) + " of " + base::quoted(options.owner) + ", role " +
               wire::word(options.role) + ", good until " + time_text(expires, "it is revoked") +
               (file ? ", in " + options.output : "; it is not shown again"));
  return base::ExitCode::kDone;
}

base::ExitCode list_tokens_command(const Options& options, const Console& console) {
  Database db(existing_database_file(options.data_dir), Database::Mode::kReadOnly);
  require_tokens(db);
  const std::int64_t now = unix_ms();
  const std::vector<TokenRow> tokens = list_tokens(db);
  if (console.json()) {
    Json all = Json::array();
    for (const TokenRow& token : tokens) all.push_back(json_of(token, now));
    console.print(all.dump() + "\n");
    return base::ExitCode::kDone;
  }
  std::string table = fmt::format("{:>4}  {:<7}  {:<7}  {:<16}  {:<16}  {:<16}  {}\n", "ID", "ROLE", "STATE",
                                  "CREATED", "EXPIRES", "LAST USED", "OWNER");
  for (const TokenRow& token : tokens) {
    table += fmt::format("{:>4}  {:<7}  {:<7}  {:<16}  {:<16}  {:<16}  {}\n", token.id,
                         wire::word(token.role), state_of(token, now), time_text(token.created_ms, ""),
                         time_text(token.expires_ms, "never"), time_text(token.last_used_ms, "never"),
                         token.owner);
  }
  console.print(table);
  return base::ExitCode::kDone;
}

base::ExitCode revoke_token_command(const Options& options, const Console& console) {
  TokenDatabase db(options.data_dir, false);
  revoke_token(*db, options.token, unix_ms());
  console.note("token " + std::to_string(options.token) + " is worth nothing any more");
  return base::ExitCode::kDone;
}

}  // namespace affskel::server
