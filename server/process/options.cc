#include "process/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <thread>

#include "wire/version.h"

namespace affskel::server {
namespace {

constexpr int kUsageError = 2;
constexpr unsigned kMaxWorkers = 1024;

constexpr const char* kFooter = R"(
Examples:
  affskel-server --data-dir /var/lib/affskel --workers auto
  affskel-server --data-dir data --listen 127.0.0.1:7060 --listen unix:/run/affskel.sock
  affskel-client --server unix:data/server.sock submit body.off --wait

SIGTERM and SIGINT drain: nothing more is leased, workers report and give their leases back, exit 0.
DATA_DIR/server.json names process, version and the addresses actually bound while the server runs.
DATA_DIR/reserve is room kept for a full disk: there jobs wait, and can still be cancelled and deleted.
Exit codes: 0 stopped; 2 usage, address or data directory; 8 disk full; 70 internal error.)";

unsigned worker_count(const std::string& text) {
  if (text == "auto") return std::max(1U, std::thread::hardware_concurrency());
  unsigned count = 0;
  if (!CLI::detail::lexical_cast(text, count) || count > kMaxWorkers) {
    throw CLI::ValidationError("--workers", "expected 0 .. 1024 or auto, got '" + text + "'");
  }
  return count;
}

/// NaN would compare as "never idle".
CLI::Validator seconds() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0;
        return good ? "" : "must be a number of seconds >= 0, not '" + text + "'";
      },
      "");
}

/// A check that does not put its name into the help text.
CLI::Validator quietly(CLI::Validator check) {
  return check.description("");
}

void add_options(CLI::App& app, Options& options, std::string& workers) {
  app.add_option("--data-dir", options.data_dir, "Directory of the database, made if absent")
      ->required()
      ->type_name("DIR");
  app.add_option("--listen", options.listen,
                 "unix:PATH or HOST:PORT of this machine, repeatable; port 0 = any free one; default "
                 "unix:DATA_DIR/server.sock")
      ->type_name("ADDR")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--workers", workers, "Local workers to start and keep running; auto = one per core")
      ->type_name("N|auto")
      ->capture_default_str();
  app.add_option("--worker-threads", options.worker_threads,
                 "Threads of each local worker; default: the cores shared out among the workers")
      ->check(quietly(CLI::Range(1U, kMaxWorkers)))
      ->type_name("N");
  app.add_option("--worker-binary", options.worker_binary,
                 "The worker program; default: affskel-worker next to this program, else on the PATH")
      ->check(quietly(CLI::ExistingFile))
      ->type_name("FILE");
  app.add_option("--idle-exit", options.idle_exit_s,
                 "Exit after this many seconds without work, client calls and watchers")
      ->check(seconds())
      ->type_name("S");
  app.add_option("--lease-ms", options.lease_ms, "A worker silent for this long loses its lease")
      ->check(quietly(CLI::Range(10, 3600000)))
      ->type_name("MS")
      ->capture_default_str();
  app.add_option("--report-interval-ms", options.report_interval_ms, "How often workers report")
      ->check(quietly(CLI::Range(1, 3600000)))
      ->type_name("MS")
      ->capture_default_str();
  app.add_option("--max-mesh-mb", options.max_mesh_mb, "Largest mesh file taken, in MiB")
      ->check(quietly(CLI::Range(1, 1 << 20)))
      ->type_name("MB")
      ->capture_default_str();
  app.add_option("--log-level", options.log_level,
                 "What is logged to stderr: debug, info, warn, error or off")
      ->check(quietly(CLI::IsMember({"debug", "info", "warn", "error", "off"})))
      ->type_name("LEVEL")
      ->capture_default_str();
  app.set_config("--config", "", "Read options from a TOML or INI file, named as here without the dashes")
      ->type_name("FILE");
}

}  // namespace

ParsedOptions parse_options(int argc, char** argv) {
  ParsedOptions parsed;
  std::string workers = "0";
  CLI::App app("Queue and store of the affine skeleton service", "affskel-server");
  app.set_version_flag("--version", std::string("affskel-server ") + wire::kVersion);
  app.footer(kFooter);
  add_options(app, parsed.options, workers);
  try {
    app.parse(argc, argv);
    parsed.options.workers = worker_count(workers);
    if (parsed.options.report_interval_ms >= parsed.options.lease_ms) {
      throw CLI::ValidationError("--report-interval-ms", "must be less than --lease-ms");
    }
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = app.exit(error) == 0 ? 0 : kUsageError;
  }
  return parsed;
}

}  // namespace affskel::server
