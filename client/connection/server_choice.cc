#include "client/connection/server_choice.h"

#include <cerrno>
#include <fstream>
#include <stdexcept>

#include "client/base/error.h"

namespace affskel::client {
namespace {

std::string trim(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

ServerChoice choice_from(const std::string& text, const std::string& origin, const std::string& file = {},
                         std::uint64_t line = 0) {
  try {
    ServerChoice choice{false, wire::parse_address(text), origin};
    return choice;
  } catch (const std::invalid_argument& error) {
    throw ClientError(ExitCode::kUsage, file.empty() ? origin + ": " + error.what() : error.what(), file,
                      line);
  }
}

}  // namespace

Config read_config(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    if (errno == ENOENT || errno == ENOTDIR) return {};
    throw error_from_errno(errno, "cannot read the configuration", file);
  }
  Config config;
  std::string line;
  for (std::uint64_t number = 1; std::getline(in, line); ++number) {
    const std::string text = trim(line);
    if (text.empty() || text.front() == '#') continue;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      throw ClientError(ExitCode::kUsage, "expected 'server = ADDR', found '" + text + "'", file, number);
    }
    const std::string key = trim(text.substr(0, equals));
    if (key != "server") {
      throw ClientError(ExitCode::kUsage, "unknown key '" + key + "'; the one key is 'server'", file, number);
    }
    config.server = trim(text.substr(equals + 1));
    config.server_line = number;
    if (config.server.empty()) throw ClientError(ExitCode::kUsage, "no address after '='", file, number);
  }
  if (in.bad()) throw error_from_errno(errno, "cannot read the configuration", file);
  return config;
}

std::filesystem::path config_file(const Environment& environment) {
  return xdg_directory(environment, "XDG_CONFIG_HOME", ".config") / "affskel" / "config";
}

ServerChoice choose_server(const std::string& option, const Environment& environment) {
  if (!option.empty()) return choice_from(option, "--server");
  if (const auto value = environment.get("AFFSKEL_SERVER")) return choice_from(*value, "$AFFSKEL_SERVER");
  const std::filesystem::path file = config_file(environment);
  const Config config = read_config(file);
  if (!config.server.empty()) return choice_from(config.server, file, file, config.server_line);
  ServerChoice embedded;
  embedded.embedded = true;
  embedded.origin = "embedded";
  return embedded;
}

}  // namespace affskel::client
