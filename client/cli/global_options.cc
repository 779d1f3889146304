#include "client/cli/global_options.h"

#include <CLI/CLI.hpp>

#include "client/cli/value_checks.h"

namespace affskel::client {

void add_global_options(CLI::App& app, GlobalOptions& options) {
  app.add_option("--server", options.server,
                 "unix:PATH or HOST:PORT; else $AFFSKEL_SERVER, else the configuration file,\n"
                 "else a private server that starts and leaves by itself")
      ->check(non_empty())
      ->type_name("ADDR");
  app.add_flag("--json", options.json, "One JSON document on stdout; errors as JSON on stderr");
  app.add_flag("-q,--quiet", options.quiet, "No notes and no progress");
}

}  // namespace affskel::client
