#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <stop_token>
#include <system_error>

#include "affskel/v1/types.pb.h"
#include "base/end_limit.h"
#include "base/exit_code.h"
#include "base/logfmt.h"
#include "base/standard_streams.h"
#include "base/stop_signals.h"
#include "compute.h"
#include "core/base/error.h"
#include "loop/lease_loop.h"
#include "wire/address.h"
#include "wire/grpc_log.h"
#include "wire/version.h"
#include "wire/words.h"

namespace {

[[gnu::section(".preinit_array"),
  gnu::used]] void (*const at_first)(int, char**, char**) = affskel::base::keep_standard_streams;

using affskel::core::CoreError;

using affskel::base::ExitCode;

ExitCode exit_code(const CoreError& error) {
  switch (error.code()) {
    case CoreError::Code::kBadInput:
      return ExitCode::kBadInput;
    case CoreError::Code::kLimit:
      return ExitCode::kLimit;
    default:
      return ExitCode::kInternal;
  }
}

// Of an output that cannot be written.
ExitCode exit_code(const std::error_code& error) {
  for (const std::errc full : {std::errc::no_space_on_device, std::errc::file_too_large}) {
    if (error == full) return ExitCode::kLimit;
  }
  if (error.value() == EDQUOT) return ExitCode::kLimit;
  for (const std::errc closed :
       {std::errc::permission_denied, std::errc::operation_not_permitted, std::errc::read_only_file_system}) {
    if (error == closed) return ExitCode::kNotAllowed;
  }
  return ExitCode::kUsage;
}

ExitCode run_compute(const affskel::worker::ComputeOptions& options) {
  try {
    affskel::worker::compute(options);
    return ExitCode::kDone;
  } catch (const CoreError& error) {
    std::fprintf(stderr, "affskel-worker: %s: %s\n", options.file.c_str(), error.what());
    return exit_code(error);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "affskel-worker: %s: not enough memory\n", options.file.c_str());
    return ExitCode::kLimit;
  } catch (const std::system_error& error) {
    std::fprintf(stderr, "affskel-worker: %s\n", error.what());
    return exit_code(error.code());
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "affskel-worker: %s\n", error.what());
    return ExitCode::kUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "affskel-worker: %s\n", error.what());
    return ExitCode::kBadInput;
  }
}

// Beyond the direction in hand and its report; what was not reported is computed again.
constexpr std::chrono::seconds kLongestEnd{60};

void limit_the_end() {
  affskel::base::EndLimit limit;
  limit.limit = kLongestEnd;
  limit.entry =
      "event=stuck message=\"the end takes too long; leaving without it, the lease ends by itself\"";
  limit.exit_code = static_cast<int>(ExitCode::kInternal);
  affskel::base::set_end_limit(limit);
}

ExitCode run_worker(const affskel::worker::LeaseLoopOptions& options) {
  try {
    affskel::wire::parse_address(options.server);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "affskel-worker: %s\n", error.what());
    return ExitCode::kUsage;
  }
  limit_the_end();
  std::stop_source stop;
  try {
    const affskel::base::StopSignals signals([&stop](int) { stop.request_stop(); });
    const ExitCode code = run_lease_loop(options, stop.get_token());
    affskel::base::limit_end();
    return code;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "affskel-worker: %s\n", error.what());
    return ExitCode::kUsage;
  } catch (const std::exception& error) {
    spdlog::critical(affskel::base::logfmt("internal_error", {{"message", error.what()}}));
    return ExitCode::kInternal;
  }
}

struct Flags {
  affskel::worker::LeaseLoopOptions loop;
  affskel::worker::ComputeOptions compute;
  std::string log_level = "info";
  std::int64_t idle_exit_s = 0;
  std::int64_t patience_s = 60;
  std::int64_t prepare_limit_s = 3600;
  std::int64_t derive_limit_s = 0;
  unsigned derive_threads = 0;
};

// What it works for, and with.
void add_work(CLI::App& app, Flags& flags) {
  app.add_option("--server", flags.loop.server, "server to work for: unix:PATH or HOST:PORT");
  app.add_option("--threads", flags.loop.threads, "computing threads")
      ->check(CLI::Range(1U, 1024U))
      ->capture_default_str();
  app.add_option(
         "--derive-threads", flags.derive_threads,
         "threads of a skeleton, surface or other artefact, while other workers of the machine mostly "
         "wait for it; 0 = as many as --threads")
      ->check(CLI::Range(0U, 1024U))
      ->capture_default_str();
  app.add_option(
         "--memory", flags.loop.memory,
         "bytes that the worker may take, with K, M or G for powers of 1024: tasks that need more go to "
         "others; default: what is available of machine, control group and ulimit when it starts")
      ->transform(CLI::AsSizeValue(false).description(""))
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 60).description(""))
      ->type_name("BYTES");
  app.add_option(
         "--prepare-limit", flags.prepare_limit_s,
         "seconds of processor time that making a mesh ready may take, or its job fails; 0 = no limit; "
         "else $AFFSKEL_PREPARE_LIMIT")
      ->envname("AFFSKEL_PREPARE_LIMIT")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000'000}))
      ->capture_default_str();
  app.add_option(
         "--derive-limit", flags.derive_limit_s,
         "seconds of processor time that a skeleton, surface or other artefact may take, or it fails; 0 = no limit; "
         "else $AFFSKEL_DERIVE_LIMIT")
      ->envname("AFFSKEL_DERIVE_LIMIT")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000'000}))
      ->capture_default_str();
}

// How long it stays, and what it tells.
void add_stay(CLI::App& app, Flags& flags) {
  app.add_option("--idle-exit", flags.idle_exit_s, "leave after this many seconds without work; 0 = never")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000'000}))
      ->capture_default_str();
  app.add_option("--max-jobs", flags.loop.max_jobs,
                 "leave when work on one more job than this is offered; 0 = never")
      ->capture_default_str();
  app.add_option("--patience", flags.patience_s,
                 "leave when the server does not answer for this many seconds")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--log-level", flags.log_level, "debug, info, warn, error or off")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
}

void add_access(CLI::App& app, Flags& flags) {
  app.add_option("--token-file", flags.loop.access.token_file,
                 "file whose first line is the token to show; else $AFFSKEL_TOKEN_FILE")
      ->envname("AFFSKEL_TOKEN_FILE");
  app.add_option("--tls-ca", flags.loop.access.tls_ca,
                 "who signed the server's certificate, PEM: speak TLS; else $AFFSKEL_TLS_CA")
      ->envname("AFFSKEL_TLS_CA");
  app.add_option("--client-cert", flags.loop.access.tls_cert,
                 "own certificate, PEM, for servers that ask for one; else $AFFSKEL_CLIENT_CERT")
      ->envname("AFFSKEL_CLIENT_CERT");
  app.add_option("--client-key", flags.loop.access.tls_key, "its key, PEM; else $AFFSKEL_CLIENT_KEY")
      ->envname("AFFSKEL_CLIENT_KEY");
}

CLI::App* add_compute(CLI::App& app, Flags& flags) {
  CLI::App* compute = app.add_subcommand("compute", "prepare and erode in this process, without a server");
  compute->add_option("FILE", flags.compute.file, "closed triangle mesh, as affskel-client reads it")
      ->required();
  compute->add_option("--spacing", flags.compute.spacing, "lattice spacing in mesh units")
      ->check([](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0;
        return good ? std::string() : "must be a number > 0, not '" + text + "'";
      });
  compute
      ->add_option("--points", flags.compute.points,
                   "aim at this many sample points, unless --spacing is given")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  compute
      ->add_option("--directions", flags.compute.directions,
                   "triangles, sphere:N, random:N:SEED, joined by +")
      ->capture_default_str();
  compute
      ->add_option("--minimum", flags.compute.minimum,
                   "E is the least over the directions (set), or over all that there are (infimum)")
      ->check(CLI::IsMember({"set", "infimum"}))
      ->capture_default_str();
  compute->add_option("--frame", flags.compute.frame, "axes of the lattice: axis, pca, obb or affine")
      ->check(CLI::IsMember(affskel::wire::words(*affskel::v1::Frame_descriptor())))
      ->capture_default_str();
  compute->add_option("--threads", flags.compute.threads, "computing threads")
      ->check(CLI::Range(1U, 1024U))
      ->capture_default_str();
  compute->add_option("--repair", flags.compute.repair_mode, "auto or none")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str();
  compute->add_flag("!--no-prune", flags.compute.prune,
                    "evaluate every point for every direction (a yardstick)");
  compute->add_flag("--shuffle", flags.compute.shuffle, "work in a random order (the field must not change)");
  compute->add_option("-o,--output", flags.compute.output,
                      "write the field: .csv .dat .vti .vts .vtkhdf .hdf");
  return compute;
}

// @return the command.
CLI::App* declare(CLI::App& app, Flags& flags) {
  app.set_version_flag("--version", std::string("affskel-worker ") + affskel::wire::kVersion);
  app.footer(
      "Examples:\n"
      "  affskel-worker --server unix:/run/affskel/server.sock --threads 4\n"
      "  affskel-worker --server lab.example.org:7060 --tls-ca ca.pem --token-file worker.token\n"
      "  affskel-worker compute body.off --spacing 200 -o body.vti");
  add_work(app, flags);
  add_stay(app, flags);
  add_access(app, flags);
  return add_compute(app, flags);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is then told as a full disk
  CLI::App app("affskel-worker: computes erosion fields for a server, or by itself.");
  Flags flags;
  const CLI::App* compute = declare(app, flags);
  try {
    app.parse(argc, argv);
    if (!*compute && flags.loop.server.empty()) throw CLI::RequiredError("--server or the command compute");
  } catch (const CLI::ParseError& error) {
    std::ostringstream help;
    const bool asked_for = app.exit(error, help, std::cerr) == 0;
    return static_cast<int>(asked_for ? affskel::base::show_help("affskel-worker", help.str())
                                      : ExitCode::kUsage);
  }
  if (*compute) return static_cast<int>(run_compute(flags.compute));
  const auto logger = spdlog::stderr_logger_mt("affskel-worker");
  // The format of the server's log, in which the lines of supervised workers appear.
  logger->set_pattern(affskel::base::kLogPattern, spdlog::pattern_time_type::utc);
  logger->set_level(spdlog::level::from_str(flags.log_level));
  spdlog::set_default_logger(logger);
  const affskel::wire::GrpcLog grpc_log([](bool is_error, const std::string& entry) {
    spdlog::log(is_error ? spdlog::level::warn : spdlog::level::debug, entry);
  });
  flags.loop.idle_exit = std::chrono::seconds(flags.idle_exit_s);
  flags.loop.prepare_limit = std::chrono::seconds(flags.prepare_limit_s);
  flags.loop.derive_threads = flags.derive_threads != 0 ? flags.derive_threads : flags.loop.threads;
  flags.loop.derive_limit = std::chrono::seconds(flags.derive_limit_s);
  flags.loop.patience = std::chrono::seconds(flags.patience_s);
  return static_cast<int>(run_worker(flags.loop));
}
