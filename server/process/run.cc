#include "process/run.h"

#include <malloc.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/end_limit.h"
#include "base/exit_code.h"
#include "base/logfmt.h"
#include "base/service_manager.h"
#include "database/errors.h"
#include "process/data_dir.h"
#include "process/file_limit.h"
#include "process/maintenance.h"
#include "process/signals.h"
#include "process/supervisor.h"
#include "services/server.h"
#include "services/watchdog.h"
#include "wire/grpc_log.h"
#include "wire/identity.h"
#include "wire/version.h"

namespace affskel::server {
namespace {

// Between looks at workers that are due and at idleness; signals are noticed at once.
constexpr std::chrono::milliseconds kGlance{100};

// Workers finish the direction in hand and report; one that needs longer loses at most that.
constexpr std::chrono::milliseconds kWorkerGrace{5000};

// Calls that are under way by then.
constexpr std::chrono::milliseconds kCallGrace{2000};

// Both, and the rest of it on a machine where each commit takes a second.
constexpr std::chrono::seconds kLongestEnd{60};

void log_for_grpc(bool is_error, const std::string& entry) {
  spdlog::log(is_error ? spdlog::level::warn : spdlog::level::debug, entry);
}

void start_logging(const std::string& level) {
  const auto logger =
      std::make_shared<spdlog::logger>("affskel", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern(base::kLogPattern, spdlog::pattern_time_type::utc);
  logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(logger);
}

std::vector<wire::Address> listen_addresses(const Options& options, const std::string& data_dir) {
  std::vector<wire::Address> addresses;
  for (const std::string& text : options.listen) addresses.push_back(wire::parse_address(text));
  // Its own workers and its watchdog come by a socket of the file system, which needs neither TLS nor tokens.
  const bool has_socket =
      std::any_of(addresses.begin(), addresses.end(), [](const auto& a) { return a.is_unix; });
  if (addresses.empty() || (!has_socket && (options.workers > 0 || !options.tls_cert.empty()))) {
    addresses.push_back(wire::parse_address("unix:" + data_dir + "/server.sock"));
  }
  // The working directory may be another one for the workers and for readers of server.json.
  for (wire::Address& address : addresses) {
    if (address.is_unix && address.path[0] != '/') {
      address = wire::parse_address("unix:" + std::filesystem::absolute(address.path).string());
    }
  }
  return addresses;
}

/// Where this process and its workers call the server.
const wire::Address& nearest(const Server& server) {
  const auto& addresses = server.addresses();
  const auto best = std::find_if(addresses.begin(), addresses.end(), [](const auto& a) { return a.is_unix; });
  return best != addresses.end() ? *best : addresses.front();
}

/// Whether an administrator keeps a worker that this server has started from work: by itself, or with this host.
bool is_distrusted(Server& server, pid_t pid) {
  try {
    const std::set<std::string> distrusted = server.store().distrusted();
    if (distrusted.contains(wire::host_name())) return true;
    const std::vector<v1::WorkerInfo> workers = server.registry().list();
    return std::any_of(workers.begin(), workers.end(), [&](const v1::WorkerInfo& worker) {
      return worker.supervised() && worker.pid() == static_cast<std::uint32_t>(pid) &&
             distrusted.contains(worker.id());
    });
  } catch (const std::exception& error) {
    // It is started again after a pause, and told once more.
    spdlog::error(base::logfmt("distrust_unknown", {{"pid", pid}, {"message", error.what()}}));
    return false;
  }
}

constexpr unsigned kMostThreads = 1024;  // that a worker takes

SupervisorOptions supervisor_options(const Options& options, Server& server) {
  SupervisorOptions result;
  result.workers = options.workers;
  if (options.workers == 0) return result;
  result.is_distrusted = [&server](pid_t pid) { return is_distrusted(server, pid); };
  unsigned threads = options.worker_threads;
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency() / options.workers);
  result.command = {find_worker_binary(options.worker_binary),
                    "--server",
                    nearest(server).target(),
                    "--threads",
                    std::to_string(threads),
                    "--derive-threads",
                    std::to_string(std::min(threads * options.workers, kMostThreads)),
                    "--log-level",
                    options.log_level};
  return result;
}

/// The data directory was deleted or moved.  There is nothing left to finish, and a successor may
/// already live in a new directory of the same name: an orderly end would take its socket away.
void leave_if_lost(const DataDir& data_dir, Supervisor& supervisor) {
  if (!data_dir.lost()) return;
  base::limit_end();
  spdlog::error(base::logfmt(
      "data_dir_lost",
      {{"data_dir", data_dir.path()}, {"message", "deleted or moved while the server ran; leaving"}}));
  spdlog::default_logger()->flush();
  supervisor.terminate(std::chrono::milliseconds(0));
  std::_Exit(static_cast<int>(base::ExitCode::kUsage));
}

/// The database was removed or replaced under the server: what comes now could not be kept.
void leave_if_database_lost(Server& server, Supervisor& supervisor) {
  if (!server.store().lost()) return;
  base::limit_end();
  spdlog::error(base::logfmt(
      "database_lost",
      {{"file", server.store().file()}, {"message", "removed or replaced while the server ran; leaving"}}));
  spdlog::default_logger()->flush();
  supervisor.terminate(std::chrono::milliseconds(0));
  std::_Exit(static_cast<int>(base::ExitCode::kUsage));
}

/// Until a signal says so, or the server is not needed any more.
void serve(const Options& options, const DataDir& data_dir, const Signals& signals, Server& server,
           Supervisor& supervisor) {
  for (;;) {
    leave_if_lost(data_dir, supervisor);
    leave_if_database_lost(server, supervisor);
    supervisor.tick();
    if (signals.count() == 0) signals.wait(kGlance);
    if (signals.count() > 0) {
      spdlog::info(base::logfmt("stopping", {{"signal", signals.number()}}));
      return;
    }
    if (options.idle_exit_s && server.idle_time() >= std::chrono::duration<double>(*options.idle_exit_s)) {
      spdlog::info(base::logfmt("stopping", {{"reason", "idle"}}));
      return;
    }
  }
}

/// Many threads take turns with buffers of megabytes: with an arena for each of them, and all freed ones
/// kept, the process would stay as large as it ever was.  But giving the buffers of every report back, and
/// having them filled with zeros again, was a fifth of the server's work for jobs of millions of points.
void keep_memory_small() {
  mallopt(M_ARENA_MAX, 4);
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 32 << 20);
}

/// A server that does not answer would keep all clients waiting; one that exits is restarted, at the cost of
/// a second of work: all that was acknowledged is on the disk.
void leave_if_deaf() {
  base::leave_at_once("critical",
                      "event=deaf message=\"no answer to its own calls; leaving, to be started again\"",
                      static_cast<int>(base::ExitCode::kInternal));
}

// The workers of this process, for the signal handler that ends it.
std::atomic<const Supervisor*> supervised = nullptr;

void kill_workers() noexcept {
  if (const Supervisor* supervisor = supervised) supervisor->kill_all();
}

/// The end that comes in spite of what hangs.
void limit_the_end() {
  base::EndLimit limit;
  limit.limit = kLongestEnd;
  limit.entry = "event=stuck message=\"the end takes too long; leaving without it, nothing is lost\"";
  limit.exit_code = static_cast<int>(base::ExitCode::kInternal);
  limit.before = kill_workers;
  base::set_end_limit(limit);
}

/// No worker outlives a server that leaves so.
class Supervised {
 public:
  explicit Supervised(const Supervisor& supervisor) { supervised = &supervisor; }
  ~Supervised() { supervised = nullptr; }
  Supervised(const Supervised&) = delete;
  Supervised& operator=(const Supervised&) = delete;
};

ServerOptions server_options(const Options& options, const std::string& data_dir) {
  ServerOptions server;
  server.data_dir = data_dir;
  server.listen = listen_addresses(options, data_dir);
  server.socket_mode = options.socket_mode;
  server.tls = {options.tls_cert, options.tls_key, options.tls_client_ca};
  server.insecure = options.insecure;
  if (!options.metrics.empty()) server.metrics = wire::parse_address(options.metrics);
  server.store.lease_ms = options.lease_ms;
  server.store.report_interval_ms = options.report_interval_ms;
  server.store.max_mesh_bytes = options.max_mesh_mb << 20;
  server.store.owner_order = options.owner_order;
  server.store.policy = options.policy;
  return server;
}

/// Tells all who look for the server where it is.
void publish(const DataDir& data_dir, const Server& server) {
  std::vector<std::string> targets;
  for (const wire::Address& address : server.addresses()) {
    targets.push_back(address.target());
    spdlog::info(base::logfmt(
        "listening",
        {{"address", targets.back()}, {"version", wire::kVersion}, {"data_dir", data_dir.path()}}));
  }
  std::optional<std::string> metrics;
  if (const auto address = server.metrics_address()) {
    metrics = address->target();
    spdlog::info(base::logfmt("metrics", {{"address", *metrics}}));
  }
  data_dir.publish(targets, metrics, SystemClock().wall_ms());
}

void run_server(const Options& options) {
  umask(0077);                    // meshes and results are this user's alone
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is then told as a full disk
  keep_memory_small();
  limit_the_end();
  Signals signals;
  raise_file_limit();
  require_protected(server_options(options, options.data_dir));
  const DataDir data_dir(options.data_dir);
  Server server(server_options(options, data_dir.path()));
  Supervisor supervisor(
      supervisor_options(options, server),
      [&](pid_t pid) { server.registry().add_supervised(static_cast<std::uint32_t>(pid)); },
      [&](pid_t pid) {
        server.registry().remove_supervised(static_cast<std::uint32_t>(pid));
        try {
          server.store().release_worker(wire::host_name(), pid);
        } catch (const std::exception& error) {
          // The leases end at their deadline instead.
          spdlog::error(base::logfmt("release_failed", {{"pid", pid}, {"message", error.what()}}));
        }
      });
  const Supervised until_the_end(supervisor);
  signals.begin_serving();
  publish(data_dir, server);
  const Watchdog watchdog(nearest(server).target(), WatchdogOptions(), leave_if_deaf);
  base::notify_service_manager(base::ServiceState::kReady);
  try {
    serve(options, data_dir, signals, server, supervisor);
  } catch (...) {
    base::limit_end();
    throw;
  }
  base::limit_end();
  // Of these the first began the end, unless the server was not needed any more.
  const unsigned heard = std::min(signals.count(), 1U);
  base::notify_service_manager(base::ServiceState::kStopping);
  leave_if_lost(data_dir, supervisor);
  data_dir.withdraw();
  // First the workers may finish what is in hand, then what is left is cut off: 10 s at most.  A second
  // signal ends the first stage.
  server.drain();
  bool hurried = false;
  supervisor.terminate(kWorkerGrace, [&] { return hurried = signals.count() > heard; });
  server.stop(hurried ? std::chrono::milliseconds(0) : kCallGrace);
  spdlog::info(base::logfmt("stopped"));
}

base::ExitCode exit_code_of(const SqliteError& error) {
  if (error.primary_code() == SQLITE_FULL) return base::ExitCode::kLimit;
  return error.blames_the_file() || error.says_damaged() || error.says_device() ? base::ExitCode::kUsage
                                                                                : base::ExitCode::kInternal;
}

/// Threads, memory, descriptors, room and inodes may be there again in a moment: a service manager is to try.
base::ExitCode exit_code_of(const std::system_error& error) {
  const int code = error.code().value();
  if (code == ENOSPC || code == EDQUOT) return base::ExitCode::kLimit;
  const bool short_of_something = code == EAGAIN || code == ENOMEM || code == EMFILE || code == ENFILE;
  return short_of_something ? base::ExitCode::kInternal : base::ExitCode::kUsage;
}

int fail(base::ExitCode code, const std::exception& error) {
  base::limit_end();
  std::cerr << "affskel-server: " << error.what() << '\n';
  return static_cast<int>(code);
}

}  // namespace

int run(const Options& options) {
  // Commands speak for themselves.
  start_logging(options.command == Command::kServe ? options.log_level : "off");
  const wire::GrpcLog grpc_log(log_for_grpc);
  if (options.command != Command::kServe) return run_maintenance(options);
  try {
    run_server(options);
    return 0;
  } catch (const StoreError& error) {
    return fail(base::ExitCode::kUsage, error);
  } catch (const SqliteError& error) {
    return fail(exit_code_of(error), error);
  } catch (const std::system_error& error) {
    return fail(exit_code_of(error), error);
  } catch (const std::runtime_error& error) {
    return fail(base::ExitCode::kUsage, error);
  } catch (const std::invalid_argument& error) {
    return fail(base::ExitCode::kUsage, error);
  } catch (const std::exception& error) {
    return fail(base::ExitCode::kInternal, error);
  }
}

}  // namespace affskel::server
