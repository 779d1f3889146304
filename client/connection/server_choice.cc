#include "client/connection/server_choice.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "client/base/error.h"

namespace affskel::client {
namespace {

std::string trim(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// In quotes or without: in the server's own configuration they have to be.
std::string unquoted(const std::string& text) {
  const bool quoted =
      text.size() > 1 && text.front() == text.back() && (text.front() == '"' || text.front() == '\'');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

ServerChoice choice_from(const std::string& text, const std::string& origin, const std::string& file = {},
                         std::uint64_t line = 0) {
  try {
    ServerChoice choice;
    choice.address = wire::parse_address(text);
    choice.origin = origin;
    return choice;
  } catch (const std::invalid_argument& error) {
    throw ClientError(ExitCode::kUsage, file.empty() ? origin + ": " + error.what() : error.what(), file,
                      line);
  }
}

/// A file that is shown to servers, by its names.
struct AccessFile {
  const char* key;       // in the configuration
  const char* variable;  // of the environment
  std::string wire::AccessFiles::*member;
};

constexpr AccessFile kFiles[] = {
    {"token_file", "AFFSKEL_TOKEN_FILE", &wire::AccessFiles::token_file},
    {"tls_ca", "AFFSKEL_TLS_CA", &wire::AccessFiles::tls_ca},
    {"client_cert", "AFFSKEL_CLIENT_CERT", &wire::AccessFiles::tls_cert},
    {"client_key", "AFFSKEL_CLIENT_KEY", &wire::AccessFiles::tls_key},
};

std::string keys() {
  std::string text = "server";
  for (const AccessFile& file : kFiles) text += std::string(", ") + file.key;
  return text;
}

/// Where nothing is said yet, what the environment says, then the configuration of the server.
void fill_in(wire::AccessFiles& access, const Environment& environment, const wire::AccessFiles& configured) {
  for (const AccessFile& file : kFiles) {
    std::string& path = access.*(file.member);
    if (path.empty()) path = environment.get(file.variable).value_or("");
    if (path.empty()) path = configured.*(file.member);
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
      throw ClientError(ExitCode::kUsage, "expected 'KEY = VALUE', found '" + text + "'", file, number);
    }
    const std::string key = trim(text.substr(0, equals));
    const std::string value = unquoted(trim(text.substr(equals + 1)));
    if (key == "server") {
      if (value.empty()) throw ClientError(ExitCode::kUsage, "no address after '='", file, number);
      config.server = value;
      config.server_line = number;
      continue;
    }
    const auto* known = std::find_if(std::begin(kFiles), std::end(kFiles),
                                     [&](const AccessFile& one) { return key == one.key; });
    if (known == std::end(kFiles))
      throw ClientError(ExitCode::kUsage, "unknown key '" + key + "'; the keys are " + keys(), file, number);
    if (value.empty()) throw ClientError(ExitCode::kUsage, "no file after '='", file, number);
    config.access.*(known->member) = (file.parent_path() / value).string();
  }
  if (in.bad()) throw error_from_errno(errno, "cannot read the configuration", file);
  return config;
}

std::filesystem::path config_file(const Environment& environment) {
  return xdg_directory(environment, "XDG_CONFIG_HOME", ".config") / "affskel" / "config";
}

ServerChoice choose_server(const std::string& option, const Environment& environment,
                           const wire::AccessFiles& access) {
  ServerChoice choice;
  wire::AccessFiles configured;
  if (!option.empty()) {
    choice = choice_from(option, "--server");
  } else if (const auto value = environment.get("AFFSKEL_SERVER")) {
    choice = choice_from(*value, "$AFFSKEL_SERVER");
  } else {
    const std::filesystem::path file = config_file(environment);
    const Config config = read_config(file);
    if (config.server.empty()) {
      choice.embedded = true;
      choice.origin = "embedded";
      return choice;
    }
    choice = choice_from(config.server, file, file, config.server_line);
    configured = config.access;
  }
  choice.access = access;
  fill_in(choice.access, environment, configured);
  return choice;
}

}  // namespace affskel::client
