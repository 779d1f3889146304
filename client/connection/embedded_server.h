#pragma once

#include <chrono>
#include <filesystem>

#include "client/base/notice.h"
#include "client/connection/environment.h"
#include "wire/address.h"

namespace affskel::client {

/// Where the private server lives.
struct EmbeddedPaths {
  std::filesystem::path home;    ///< its data directory, absolute
  std::filesystem::path socket;  ///< at most 107 bytes
  std::filesystem::path log;     ///< what the server printed
  /// Directory made for the socket alone because `home` is too deep for one; empty = socket is in home.
  std::filesystem::path socket_dir;
};

/// $AFFSKEL_HOME, else $XDG_DATA_HOME/affskel or ~/.local/share/affskel; the socket is `server.sock` in it.
/// A Unix socket's path has at most 107 bytes: when that is exceeded, the socket goes to a directory named
/// after a hash of `home` under $XDG_RUNTIME_DIR or /tmp.
EmbeddedPaths embedded_paths(const Environment& environment);

/// Creates `directory` (and its parents) with mode 0700, or checks that the existing one is a directory of
/// ours.  With `only_ours`, also that it is no symbolic link and that no other user can enter it.
/// @throws ClientError kNotAllowed with the cause.
void make_private_directory(const std::filesystem::path& directory, bool only_ours);

/// `affskel-server` in the directory `beside`, else the first in $PATH.
/// @throws ClientError kUnreachable when there is none.
std::filesystem::path find_server_program(const std::filesystem::path& beside,
                                          const Environment& environment);

struct EmbeddedOptions {
  std::filesystem::path program;  ///< the server; empty = next to this program, else in $PATH
  std::chrono::milliseconds patience{15000};
  std::chrono::milliseconds poll{10};
  /// How long to wait for another server after our own gave up (it lost the race for the data directory).
  std::chrono::milliseconds grace{3000};
};

/// Makes sure that a private server answers on `paths.socket`, starting one if needed, and returns its
/// address.  Two clients may do this at once: the server locks its data directory, the second one exits.
/// @throws ClientError kUnreachable with the end of the server's log when none answers in time.
wire::Address ensure_embedded_server(const EmbeddedPaths& paths, const EmbeddedOptions& options,
                                     const Environment& environment, const Listener& listener);

}  // namespace affskel::client
