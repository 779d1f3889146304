#include "process/maintenance.h"

#include <sqlite3.h>

#include <cerrno>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/exit_code.h"
#include "base/quoted.h"
#include "base/standard_streams.h"
#include "check/backup.h"
#include "check/check_database.h"
#include "check/repair.h"
#include "database/database_file.h"
#include "database/errors.h"
#include "database/migrate.h"
#include "database/sqlite.h"
#include "database/sqlite_error.h"
#include "process/console.h"
#include "process/data_dir.h"
#include "process/token_command.h"
#include "store/distrust.h"

namespace affskel::server {
namespace {

/// What a repair leaves, or fails at, is not for another.
std::string advice_after(bool repair, std::string message) {
  const std::size_t at = message.find(kDamagedAdvice);
  if (repair && at != std::string::npos)
    message.replace(at, std::string_view(kDamagedAdvice).size(), "restore a backup");
  return message;
}

/// Returns the number of repairs.
std::int64_t repair(const Options& options, const Console& console) {
  // Looked for first: taking hold of the directory would make it.
  existing_database_file(options.data_dir);
  const DataDir held(options.data_dir);
  std::int64_t repairs = 0;
  repair_database(options.data_dir, [&](const std::string& action) {
    ++repairs;
    console.note("repaired: " + action);
  });
  return repairs;
}

base::ExitCode check_command(const Options& options, const Console& console) {
  const std::int64_t repairs = options.repair ? repair(options, console) : 0;
  const auto on_fault = [&](const Fault& fault) {
    console.fault(fault.where + ": " + advice_after(options.repair, fault.what));
  };
  const std::string server = data_dir_holder(options.data_dir).value_or("none");
  const CheckResult found = check_database(options.data_dir, on_fault);
  if (found.schema != 0 && found.schema < newest_schema()) {
    console.note((found.schema == kBeforeFirst ? "the schema" : "schema " + std::to_string(found.schema)) +
                 " is older than this program's, " + std::to_string(newest_schema()) +
                 ": its content was not checked; affskel-server migrate brings it up to date");
  }
  nlohmann::ordered_json result = {{"database", database_file(options.data_dir)},
                                   {"server", server},
                                   {"schema", found.schema},
                                   {"newest_schema", newest_schema()},
                                   {"complete", found.complete},
                                   {"jobs", found.jobs},
                                   {"meshes", found.meshes},
                                   {"fields", found.fields},
                                   {"artifacts", found.artifacts},
                                   {"faults", found.faults},
                                   {"sound", found.faults == 0}};
  if (options.repair) result["repairs"] = repairs;
  console.result(result);
  return found.faults == 0 ? base::ExitCode::kDone : base::ExitCode::kFaults;
}

/// Signals that would end the program wait, so that nothing half-written stays behind.
class HeldSignals {
 public:
  HeldSignals() {
    sigemptyset(&set_);
    for (int number : {SIGTERM, SIGINT, SIGHUP}) {
      if (!is_ignored(number)) sigaddset(&set_, number);
    }
    pthread_sigmask(SIG_BLOCK, &set_, &before_);
  }
  ~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  /// Takes one that waits, if there is one.
  bool take() const {
    const timespec at_once{};
    return sigtimedwait(&set_, nullptr, &at_once) > 0;
  }

 private:
  // A signal that is ignored (nohup) stays ignored: blocked, it would become pending.
  static bool is_ignored(int number) {
    struct sigaction now {};
    return sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
  }

  sigset_t set_{};
  sigset_t before_{};
};

base::ExitCode backup_command(const Options& options, const Console& console) {
  const HeldSignals signals;
  const Backup backup =
      back_up(options.data_dir, options.output, {options.force, [&] { return !signals.take(); }});
  if (!backup.complete) {
    console.error(base::ExitCode::kCancelled, "interrupted; " + options.output + " was not written");
    return base::ExitCode::kCancelled;
  }
  console.result({{"backup", options.output}, {"bytes", backup.bytes}, {"schema", backup.schema}});
  while (signals.take()) {  // too late: it is written
  }
  return base::ExitCode::kDone;
}

/// Refused before anything is changed: opening a database for writing changes its journal mode.
int schema_before(const std::string& file) {
  Database db(file, Database::Mode::kReadOnly);
  return checked_schema(db);
}

base::ExitCode migrate_command(const Options& options, const Console& console) {
  // Looked for first: taking hold of the directory would make it.
  const std::string file = existing_database_file(options.data_dir);
  const DataDir held(options.data_dir);
  const int from = schema_before(file);
  if (from == newest_schema()) {
    console.note("the schema is up to date, nothing to do");
    console.result({{"database", file}, {"from", from}, {"to", from}});
    return base::ExitCode::kDone;
  }
  Database db(file, Database::Mode::kReadWrite);
  console.result({{"database", file}, {"from", from}, {"to", migrate(db)}});
  return base::ExitCode::kDone;
}

base::ExitCode trust_command(const Options& options, const Console& console) {
  const std::string file = existing_database_file(options.data_dir);
  std::optional<DataDir> held;  // against a server, or another command, that begins meanwhile
  if (!data_dir_holder(options.data_dir)) held.emplace(options.data_dir);
  schema_before(file);
  Database db(file, Database::Mode::kReadWrite);
  trust(db, options.trusted);
  console.note("workers of " + base::quoted(options.trusted) +
               " get work again; those that left are to be started anew");
  return base::ExitCode::kDone;
}

base::ExitCode run_command(const Options& options, const Console& console) {
  switch (options.command) {
    case Command::kCheck:
      return check_command(options, console);
    case Command::kBackup:
      return backup_command(options, console);
    case Command::kMigrate:
      return migrate_command(options, console);
    case Command::kTokenAdd:
      return add_token_command(options, console);
    case Command::kTokenList:
      return list_tokens_command(options, console);
    case Command::kTokenRevoke:
      return revoke_token_command(options, console);
    case Command::kTrust:
      return trust_command(options, console);
    case Command::kServe:
      break;
  }
  throw std::logic_error("not a command on a data directory");
}

base::ExitCode code_of(const StoreError& error) {
  switch (error.code()) {
    case StoreError::Code::kInvalid:
      return base::ExitCode::kUsage;
    case StoreError::Code::kNotFound:
      return base::ExitCode::kNotFound;
    default:
      return base::ExitCode::kBadInput;
  }
}

base::ExitCode code_of(const SqliteError& error) {
  switch (error.primary_code()) {
    case SQLITE_FULL:
      return base::ExitCode::kLimit;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return base::ExitCode::kNotAllowed;
    case SQLITE_IOERR:
      return base::ExitCode::kBadInput;
    default:
      return error.blames_the_file() ? base::ExitCode::kBadInput : base::ExitCode::kInternal;
  }
}

base::ExitCode code_of(const std::system_error& error) {
  switch (error.code().value()) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return base::ExitCode::kLimit;
    case EEXIST:
      return base::ExitCode::kNotAllowed;
    default:
      return base::ExitCode::kBadInput;
  }
}

}  // namespace

int run_maintenance(const Options& options) {
  // A reader that has gone is then told as an error: a token that nobody saw must be taken back.
  std::signal(SIGPIPE, SIG_IGN);
  const Console console(options.json);
  const auto fail = [&](base::ExitCode code, const std::exception& error) {
    console.error(code, error.what());
    return static_cast<int>(code);
  };
  try {
    // Known now, not when all is done.
    const bool tells = options.command != Command::kTokenRevoke && options.command != Command::kTrust;
    if (tells && base::standard_output_is_closed()) throw base::OutputError(EBADF);
    return static_cast<int>(run_command(options, console));
  } catch (const StoreError& error) {
    return fail(code_of(error), error);
  } catch (const SqliteError& error) {
    const base::ExitCode code = code_of(error);
    console.error(code, advice_after(options.repair, error.what()));
    return static_cast<int>(code);
  } catch (const DataDirInUse& error) {
    return fail(base::ExitCode::kNotAllowed, error);
  } catch (const base::OutputError& error) {
    if (error.code() == base::ExitCode::kClosedPipe) return static_cast<int>(error.code());
    return fail(error.code(), error);
  } catch (const std::system_error& error) {
    const base::ExitCode code = code_of(error);
    const char* remedy = code == base::ExitCode::kNotAllowed ? "; --force replaces it" : "";
    console.error(code, error.what() + std::string(remedy));
    return static_cast<int>(code);
  } catch (const std::runtime_error& error) {  // a directory that cannot be used
    return fail(base::ExitCode::kBadInput, error);
  } catch (const std::exception& error) {
    return fail(base::ExitCode::kInternal, error);
  }
}

}  // namespace affskel::server
