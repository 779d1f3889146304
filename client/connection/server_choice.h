#pragma once

#include <filesystem>
#include <string>

#include "client/connection/environment.h"
#include "wire/address.h"

namespace affskel::client {

/// Which server to talk to.
struct ServerChoice {
  bool embedded = false;  ///< a private one, started on demand; the address is not set then
  wire::Address address;
  std::string origin;  ///< where the choice comes from, for messages: "--server", "$AFFSKEL_SERVER", a file
};

/// What the configuration file says.
struct Config {
  std::string server;  ///< empty = nothing said
  std::uint64_t server_line = 0;
};

/// Reads `KEY = VALUE` lines; `#` starts a comment line.  The one key is `server`.
/// @throws ClientError kUsage with file and line for anything else; a missing file is an empty one.
Config read_config(const std::filesystem::path& file);

/// $XDG_CONFIG_HOME/affskel/config or ~/.config/affskel/config.
std::filesystem::path config_file(const Environment& environment);

/// `option` (the value of --server) if not empty, else $AFFSKEL_SERVER, else the configuration file, else
/// the embedded server.
/// @throws ClientError kUsage when an address is malformed, naming where it was read.
ServerChoice choose_server(const std::string& option, const Environment& environment);

}  // namespace affskel::client
