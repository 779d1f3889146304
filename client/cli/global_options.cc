#include "client/cli/global_options.h"

#include <CLI/CLI.hpp>

#include "client/cli/value_checks.h"
#include "client/text/shell_quoted.h"

namespace affskel::client {
namespace {

void add_budgets(CLI::App& app, Budgets& budgets) {
  constexpr std::uint64_t kMaxSeconds = 1'000'000'000;
  const auto add_limit = [&](const char* name, std::uint64_t& seconds, const char* what) {
    app.add_option(name, seconds, what)
        ->check(whole_number(0, kMaxSeconds))
        ->capture_default_str()
        ->type_name("S");
  };
  add_limit("--read-limit", budgets.read_limit_s,
            "Processor time that reading a mesh may take, seconds; 0: any");
  add_limit("--repair-limit", budgets.repair_limit_s,
            "Processor time that mending and checking a mesh may take, seconds; 0: any");
  app.add_option("--memory", budgets.memory,
                 "Bytes of memory that either may take, with K, M or G for powers of 1024; default: any")
      ->transform(byte_count())
      ->type_name("BYTES");
}

}  // namespace

void add_global_options(CLI::App& app, GlobalOptions& options) {
  app.add_option("--server", options.server,
                 "unix:PATH or HOST:PORT; else $AFFSKEL_SERVER, else the configuration file,\n"
                 "else a private server that starts and leaves by itself")
      ->check(non_empty())
      ->type_name("ADDR");
  const auto add_file = [&](const char* name, std::string& file, const char* what) {
    app.add_option(name, file, what)->check(non_empty())->type_name("FILE");
  };
  add_file("--token-file", options.access.token_file,
           "Its first line is the token to show; else $AFFSKEL_TOKEN_FILE");
  add_file("--tls-ca", options.access.tls_ca,
           "Who signed the server's certificate, PEM: speak TLS; else $AFFSKEL_TLS_CA");
  add_file("--client-cert", options.access.tls_cert,
           "Own certificate, PEM, for servers that ask for one; else $AFFSKEL_CLIENT_CERT");
  add_file("--client-key", options.access.tls_key, "Its key, PEM; else $AFFSKEL_CLIENT_KEY");
  app.add_flag("--json", options.json,
               "One JSON document on stdout, of log one a line; errors as JSON on stderr");
  app.add_flag("-q,--quiet", options.quiet, "No notes and no progress");
  add_budgets(app, options.budgets);
}

std::string next_command(const GlobalOptions& options, const std::string& words) {
  std::string command = "affskel-client";
  const auto add = [&command](const char* name, const std::string& value) {
    if (!value.empty()) command += std::string(" ") + name + " " + shell_quoted(value);
  };
  add("--server", options.server);
  add("--token-file", options.access.token_file);
  add("--tls-ca", options.access.tls_ca);
  add("--client-cert", options.access.tls_cert);
  add("--client-key", options.access.tls_key);
  return command + " " + words;
}

}  // namespace affskel::client
