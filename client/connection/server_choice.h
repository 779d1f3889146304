#pragma once

#include <filesystem>
#include <string>

#include "client/connection/environment.h"
#include "wire/address.h"
#include "wire/channel.h"

namespace affskel::client {

/// Which server to talk to.
struct ServerChoice {
  bool embedded = false;  ///< a private one, started on demand; the address is not set then
  wire::Address address;
  wire::AccessFiles access;  ///< what is shown to it
  std::string origin;  ///< where the choice comes from, for messages: "--server", "$AFFSKEL_SERVER", a file
};

/// What the configuration file says.
struct Config {
  std::string server;  ///< empty = nothing said
  std::uint64_t server_line = 0;
  wire::AccessFiles access;  ///< relative names are taken from the file's directory
};

/// Reads `KEY = VALUE` lines; `#` starts a comment line.  Keys: `server`, `token_file`, `tls_ca`,
/// `client_cert`, `client_key`.
/// @throws ClientError kUsage with file and line for anything else; a missing file is an empty one.
Config read_config(const std::filesystem::path& file);

/// $XDG_CONFIG_HOME/affskel/config or ~/.config/affskel/config.
std::filesystem::path config_file(const Environment& environment);

/// `option` (the value of --server) if not empty, else $AFFSKEL_SERVER, else the configuration file, else
/// the embedded server.  Each file of `access` likewise; but those of the configuration file go with its
/// server only, lest a token be shown to another, and the embedded server is shown none.
/// @throws ClientError kUsage when an address is malformed, naming where it was read.
ServerChoice choose_server(const std::string& option, const Environment& environment,
                           const wire::AccessFiles& access = {});

}  // namespace affskel::client
