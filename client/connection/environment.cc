#include "client/connection/environment.h"

#include <pwd.h>
#include <unistd.h>

#include <cstdlib>

#include "client/base/error.h"

namespace affskel::client {

Environment process_environment() {
  return {[](const std::string& name) -> std::optional<std::string> {
    const char* value = std::getenv(name.c_str());
    if (value == nullptr || *value == '\0') return std::nullopt;
    return std::string(value);
  }};
}

std::filesystem::path home_directory(const Environment& environment) {
  if (const auto home = environment.get("HOME")) return *home;
  const passwd* entry = getpwuid(geteuid());
  if (entry == nullptr || entry->pw_dir == nullptr || *entry->pw_dir == '\0') {
    throw ClientError(ExitCode::kUsage, "no home directory: set HOME, or name a server with --server");
  }
  return entry->pw_dir;
}

std::filesystem::path xdg_directory(const Environment& environment, const std::string& name,
                                    const std::string& fallback) {
  if (const auto value = environment.get(name); value && std::filesystem::path(*value).is_absolute()) {
    return *value;
  }
  return home_directory(environment) / fallback;
}

std::string user_name(const Environment& environment) {
  const passwd* entry = getpwuid(geteuid());
  if (entry != nullptr && entry->pw_name != nullptr && *entry->pw_name != '\0') return entry->pw_name;
  return environment.get("USER").value_or(std::to_string(geteuid()));
}

}  // namespace affskel::client
