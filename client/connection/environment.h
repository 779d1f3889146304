#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace affskel::client {

/// The environment variables, replaceable in tests.  A variable that is set but empty counts as not set.
struct Environment {
  std::function<std::optional<std::string>(const std::string&)> get;
};

/// The process's own.
Environment process_environment();

/// The user's home directory: $HOME, else the password database.
/// @throws ClientError when there is none.
std::filesystem::path home_directory(const Environment& environment);

/// $NAME when it is an absolute path (as the XDG base directory specification asks), else HOME/fallback.
std::filesystem::path xdg_directory(const Environment& environment, const std::string& name,
                                    const std::string& fallback);

/// Name of the user who runs this process.
std::string user_name(const Environment& environment);

}  // namespace affskel::client
