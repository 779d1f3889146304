#include "process/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <thread>
#include <utility>

#include "base/exit_code.h"
#include "base/regular_file.h"
#include "base/standard_streams.h"
#include "process/config_fault.h"
#include "process/policy_options.h"
#include "wire/version.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

constexpr unsigned kMaxWorkers = 1024;

const std::map<std::string, OwnerOrder> kOwnerOrders = {{"first-come", OwnerOrder::kFirstCome},
                                                        {"round-robin", OwnerOrder::kRoundRobin}};

constexpr const char* kFooter = R"(
Examples:
  affskel-server --data-dir /var/lib/affskel --workers auto
  affskel-server --data-dir data --listen 127.0.0.1:7060 --listen unix:/run/affskel.sock
  affskel-client --server unix:data/server.sock submit body.off --wait
  affskel-server --data-dir data --metrics 127.0.0.1:9464
  affskel-server check --data-dir data
  affskel-server backup --data-dir data -o affskel-backup.db
  affskel-server migrate --data-dir data
  affskel-server token add --data-dir data --owner ada --expires 90d -o ada.token
  affskel-server --data-dir data --listen 0.0.0.0:7060 --tls-cert server.pem --tls-key server.key

SIGTERM and SIGINT drain: nothing more is leased, workers report and give their leases back, exit 0.

Limits, quotas and retention are best kept in a file for --config:
  limit = ["queued-jobs=100K", "stored-bytes=2T"]
  quota = ["queued-jobs=2K", "stored-bytes=200G", "chords=1T", "ada:stored-bytes=500G"]
  retention = ["results-age=90d", "jobs-age=365d", "ada:results-age=0", "total-bytes=1T", "grace=7d"]
What exceeds a limit is refused, with limit and use (exit code 8 of affskel-client); points x directions that only
the mesh tells fail the job. Results go before jobs with their meshes; pinned and unfinished jobs stay. 0 is no limit,
for an owner who is to have none where the others have one.

DATA_DIR/server.json names process, version and the addresses actually bound, that of the metrics too, while the
server runs.
DATA_DIR/reserve is room kept for a full disk: there jobs wait, and can still be cancelled and deleted.
Exit codes: 0 stopped; 2 usage, address or data directory; 8 disk full; 70 internal error. Those of the commands
are in their help: affskel-server check --help.)";

constexpr const char* kCheckFooter = R"(
Reads the database as of one moment, beside a running server or without one, and changes nothing in it: the file
itself, references, sizes and SHA-256 of meshes and artefacts, checksums and values of fields, progress, jobs
and their tasks. Every fault goes to stderr, with its place and what it costs.

--repair builds indexes anew, deletes damaged rows of fields and marks their directions to be computed again,
has damaged artefacts made again, queues the jobs concerned, and then checks. It is refused while a server runs.
Make a backup first. A damaged mesh it cannot repair: submit the same file again, which mends it.

Examples:
  affskel-server check --data-dir /var/lib/affskel
  affskel-server check --data-dir data --json
  affskel-server check --repair --data-dir data

Exit codes: 0 sound; 1 faults found, or left; 2 usage; 3 no database of affskel-server, or of a newer one; 7
--repair while a server runs; 8 disk full; 70 internal error.)";

constexpr const char* kBackupFooter = R"(
Copies the database as of one moment, beside a running server or without one; nothing that was acknowledged
before is missing. FILE appears complete or not at all, readable by its owner alone. It is all that a data
directory needs: to restore, put it as affskel.db into an empty directory and start a server there; jobs go on.

Examples:
  affskel-server backup --data-dir /var/lib/affskel -o affskel-backup.db
  mkdir -m 700 restored && cp affskel-backup.db restored/affskel.db && affskel-server --data-dir restored

Exit codes: 0 done; 2 usage; 3 no database of affskel-server, or FILE cannot be written; 6 interrupted; 7 FILE
exists; 8 disk full; 70 internal error.)";

constexpr const char* kMigrateFooter = R"(
A server does the same when it starts; this does it without one, and is refused while one runs. Make a backup
first: there is no way back to an older version.

Examples:
  affskel-server migrate --data-dir /var/lib/affskel

Exit codes: 0 up to date; 2 usage; 3 no database of affskel-server, or of a newer one; 7 a server runs; 8 disk
full; 70 internal error.)";

constexpr const char* kTokenFooter = R"(
All work beside a running server and without one; the first token may be made before the server's first start. A
server that was ever given a token asks TCP callers for one. Of a token only its hash is kept; one that cannot be
written out is taken back.

Examples:
  affskel-server token add --data-dir /var/lib/affskel --owner ada --expires 90d -o ada.token
  affskel-server token add --data-dir /var/lib/affskel --owner cluster --role worker -o worker.token
  affskel-server token list --data-dir /var/lib/affskel
  affskel-server token revoke --data-dir /var/lib/affskel 3

Exit codes: 0 done; 2 usage; 3 no database of affskel-server, or of a newer one; 4 no such token; 8 disk full; 70
internal error.)";

constexpr const char* kTrustFooter = R"(
`affskel-client resume JOB --distrust HOST` keeps all workers of a host from work, over restarts of the server, too.
When its machine has been looked after, this gives them work again, and those workers there that were distrusted by
themselves. It works beside a running server and without one. Workers that were sent away are to be started anew
(systemctl restart affskel-worker@...), those of the server's own with its next start. What they gave stays taken out.

Examples:
  affskel-server trust node7 --data-dir /var/lib/affskel

Exit codes: 0 done; 2 usage; 3 no database of affskel-server, or one of another version; 4 nobody distrusts it; 8 disk
full; 70 internal error.)";

unsigned worker_count(const std::string& text) {
  if (text == "auto") return std::max(1U, std::thread::hardware_concurrency());
  unsigned count = 0;
  if (!CLI::detail::lexical_cast(text, count) || count > kMaxWorkers) {
    throw CLI::ValidationError("--workers", "expected 0 .. 1024 or auto, got '" + text + "'");
  }
  return count;
}

Policy checked_policy(const PolicyWords& words) {
  try {
    return parse_policy(words);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError(error.what());
  }
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

/// Where it listens, and who may call.
void add_addresses(CLI::App& app, Options& options) {
  app.add_option("--data-dir", options.data_dir, "Directory of the database, made if absent")
      ->required()
      ->type_name("DIR");
  app.add_option(
         "--listen", options.listen,
         "unix:PATH or HOST:PORT, repeatable; port 0 = any free one; default unix:DATA_DIR/server.sock. "
         "What other machines reach needs TLS and tokens")
      ->type_name("ADDR")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option_function<std::string>(
         "--socket-mode",
         [&options](const std::string& text) {
           options.socket_mode = static_cast<unsigned>(std::stoul(text, nullptr, 8));
         },
         "Permissions of Unix sockets: 600 lets this user connect, 660 the group, too, 666 all; default 600")
      ->check(quietly(CLI::IsMember({"600", "660", "666"})))
      ->type_name("MODE");
  CLI::Option* certificate = app.add_option("--tls-cert", options.tls_cert,
                                            "Certificate of the server, PEM: TCP addresses speak TLS")
                                 ->type_name("FILE");
  CLI::Option* key = app.add_option("--tls-key", options.tls_key, "Its private key, PEM")->type_name("FILE");
  certificate->needs(key);
  key->needs(certificate);
  app.add_option("--tls-client-ca", options.tls_client_ca,
                 "TCP callers must show a certificate that one of these has signed, PEM")
      ->needs(certificate)
      ->type_name("FILE");
  app.add_flag("--insecure", options.insecure,
               "Listen for other machines without TLS or tokens, too, and tell them the metrics");
  app.add_option(
         "--metrics", options.metrics,
         "HOST:PORT that answers GET /metrics, for Prometheus, and GET /healthz; port 0 = any free one; "
         "default: none. Nothing protects it")
      ->type_name("ADDR");
}

void add_workers(CLI::App& app, Options& options, std::string& workers) {
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
}

void add_conduct(CLI::App& app, Options& options) {
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
  app.add_option("--owner-order", options.owner_order,
                 "How the jobs of one owner share the owner's turns: first-come = the oldest has them all, "
                 "round-robin = one block each")
      ->transform(CLI::CheckedTransformer(kOwnerOrders).description(""))
      ->type_name("ORDER")
      ->default_str("first-come");
  app.add_option("--log-level", options.log_level,
                 "What is logged to stderr: debug, info, warn, error or off")
      ->check(quietly(CLI::IsMember({"debug", "info", "warn", "error", "off"})))
      ->type_name("LEVEL")
      ->capture_default_str();
  app.set_config("--config", "", "Read options from a TOML or INI file, named as here without the dashes")
      ->check([](const std::string& file) {
        const char* kind = base::kind_unless_regular(file);
        return kind == nullptr ? std::string() : file + " is " + kind + ", not a regular file";
      })
      ->type_name("FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);  // a misspelt limit would be none
}

/// What owners may use, and what is kept.
void add_policy(CLI::App& app, PolicyWords& words) {
  const auto add = [&app](const char* name, std::vector<std::string>& list, const char* type,
                          const char* what) {
    app.add_option(name, list, what)
        ->type_name(type)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  add("--limit", words.limits, "NAME=VALUE",
      "Limit of the whole server, repeatable: queued-jobs, mesh-bytes, stored-bytes, chords (of a job: "
      "points x "
      "directions)");
  add("--quota", words.quotas, "[OWNER:]NAME=VALUE",
      "The same for each owner, or for the one that is named, repeatable; and priority (0 .. 9): the highest "
      "that counts against other owners' jobs, 5 unless told");
  add("--retention", words.retentions, "[OWNER:]NAME=VALUE",
      "How long what is finished is kept, repeatable: results-age, jobs-age (90d, 12h), stored-bytes; of the "
      "whole "
      "server total-bytes, and grace, the time between notice and removal (7d)");
}

/// Adds a command that works on the data directory by itself.
/// @param parent the program, or the command that it belongs to.
CLI::App* add_command(CLI::App& app, CLI::App& parent, Options& options, const char* name, const char* what,
                      Command command) {
  CLI::App* sub = parent.add_subcommand(name, what);
  sub->add_option("--data-dir", options.data_dir, "Data directory of a server, running or not")
      ->required()
      ->type_name("DIR");
  sub->add_flag("--json", options.json, "One JSON document on stdout, errors as JSON on stderr");
  // The server's options, its data directory among them, are not those of its commands.
  sub->preparse_callback([&app](std::size_t) { app.get_option("--data-dir")->required(false); });
  sub->callback([&options, command] { options.command = command; });
  return sub;
}

/// @param text "90d": a whole number of s, m, h, d or w.
std::chrono::seconds duration_of(const std::string& text) {
  constexpr std::pair<char, std::int64_t> kUnits[] = {
      {'s', 1}, {'m', 60}, {'h', 3600}, {'d', 86400}, {'w', 604800}};
  constexpr std::int64_t kMax = std::int64_t{100} * 366 * 86400;
  const auto* unit = text.empty() ? std::end(kUnits)
                                  : std::find_if(std::begin(kUnits), std::end(kUnits),
                                                 [&](const auto& one) { return one.first == text.back(); });
  std::int64_t number = 0;
  if (unit == std::end(kUnits) || !CLI::detail::lexical_cast(text.substr(0, text.size() - 1), number) ||
      number < 1 || number > kMax / unit->second) {
    throw CLI::ValidationError(
        "--expires",
        "expected a number of s, m, h, d or w, at most 100 years, as in 90d; not '" + text + "'");
  }
  return std::chrono::seconds(number * unit->second);
}

void add_token_commands(CLI::App& app, Options& options) {
  CLI::App* token = app.add_subcommand("token", "Who may call: tokens of users, workers and admins");
  token->require_subcommand(1)->footer(kTokenFooter);
  CLI::App* add =
      add_command(app, *token, options, "add", "Make a token, and print it once", Command::kTokenAdd);
  add->footer(kTokenFooter);
  add->add_option("--owner", options.owner, "Whose jobs its holder's jobs are")
      ->required()
      ->type_name("NAME");
  add->add_option_function<std::string>(
         "--role",
         [&options](const std::string& word) {
           options.role = wire::value_of_word<v1::Role>(word).value_or(v1::ROLE_UNSPECIFIED);
         },
         "user: own jobs; worker: compute; admin: all (default user)")
      ->check(quietly(CLI::IsMember(wire::words(*v1::Role_descriptor()))))
      ->type_name("ROLE");
  add->add_option_function<std::string>(
         "--expires", [&options](const std::string& text) { options.expires = duration_of(text); },
         "It is good for so long: a number of s, m, h, d or w; default: until it is revoked")
      ->type_name("TIME");
  add->add_option("-o,--output", options.output,
                  "A new file for it, which nobody else may read; default: the standard output")
      ->type_name("FILE");
  add_command(app, *token, options, "list", "List the tokens, without what they are", Command::kTokenList)
      ->footer(kTokenFooter);
  CLI::App* revoke =
      add_command(app, *token, options, "revoke", "Make a token worthless, at once", Command::kTokenRevoke);
  revoke->footer(kTokenFooter);
  revoke->add_option("ID", options.token, "As token list has it")->required();
}

void add_commands(CLI::App& app, Options& options) {
  app.require_subcommand(0, 1);
  CLI::App* check =
      add_command(app, app, options, "check", "Check whether the database is sound", Command::kCheck);
  check->footer(kCheckFooter);
  check->add_flag("--repair", options.repair, "First repair what a damaged disk has left; no server may run");
  CLI::App* backup =
      add_command(app, app, options, "backup", "Copy the database to a file", Command::kBackup);
  backup->footer(kBackupFooter);
  backup->add_option("-o,--output", options.output, "Where to write the copy")->required()->type_name("FILE");
  backup->add_flag("--force", options.force, "Replace FILE when it exists");
  add_command(app, app, options, "migrate", "Bring the database up to date with this version",
              Command::kMigrate)
      ->footer(kMigrateFooter);
  add_token_commands(app, options);
  CLI::App* trust = add_command(app, app, options, "trust",
                                "Give the workers of a distrusted host work again", Command::kTrust);
  trust->footer(kTrustFooter);
  trust->add_option("HOST", options.trusted, "As --distrust named it, or as `log` names it")->required();
}

/// Refuses options that would be ignored.
void refuse_server_options(const CLI::App& app) {
  if (app.get_subcommands().empty()) return;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0) continue;
    throw CLI::ValidationError(
        option->get_name(),
        "goes with no command; options of '" + app.get_subcommands().front()->get_name() + "' follow it");
  }
}

CLI::ParseError told_with_place(CLI::App& app, const CLI::ParseError& error) {
  return CLI::ConfigError(config_fault(app.get_config_ptr()->as<std::string>(), error.what()));
}

}  // namespace

ParsedOptions parse_options(int argc, char** argv) {
  ParsedOptions parsed;
  std::string workers = "0";
  PolicyWords policy;
  CLI::App app("Queue and store of the affine skeleton service", "affskel-server");
  app.set_version_flag("--version", std::string("affskel-server ") + wire::kVersion);
  app.footer(kFooter);
  add_addresses(app, parsed.options);
  add_workers(app, parsed.options, workers);
  add_conduct(app, parsed.options);
  add_policy(app, policy);
  add_commands(app, parsed.options);
  try {
    app.parse(argc, argv);
    refuse_server_options(app);
    parsed.options.workers = worker_count(workers);
    parsed.options.policy = checked_policy(policy);
    if (parsed.options.report_interval_ms >= parsed.options.lease_ms) {
      throw CLI::ValidationError("--report-interval-ms", "must be less than --lease-ms");
    }
  } catch (const CLI::ParseError& error) {
    std::ostringstream help;
    const bool of_file = dynamic_cast<const CLI::ConfigError*>(&error) != nullptr;
    const bool asked_for = app.exit(of_file ? told_with_place(app, error) : error, help, std::cerr) == 0;
    parsed.exit_code =
        static_cast<int>(asked_for ? base::show_help("affskel-server", help.str()) : base::ExitCode::kUsage);
  }
  return parsed;
}

}  // namespace affskel::server
