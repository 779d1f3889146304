#include "process/console.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "base/standard_streams.h"

namespace affskel::server {
namespace {

using Json = nlohmann::ordered_json;

// Paths and damaged rows may hold any bytes.
std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Each message is one line, whatever it quotes.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  return text;
}

std::string text_of(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.is_string() ? one_line(value.get<std::string>()) : dump(value);
}

}  // namespace

void Console::result(const Json& document) const {
  if (json_) return print(dump(document) + "\n");
  std::string lines;
  for (const auto& [key, value] : document.items()) lines += key + ": " + text_of(value) + "\n";
  print(lines);
}

void Console::print(const std::string& text) const {
  base::write_standard_output(text);
}

void Console::error(base::ExitCode code, const std::string& message) const {
  report(base::exit_code_name(code), message);
}

void Console::fault(const std::string& message) const {
  report("FAULT", message);
}

void Console::report(const char* name, const std::string& message) const {
  if (json_) {
    std::cerr << dump({{"error", {{"code", name}, {"message", message}}}}) << '\n';
  } else {
    std::cerr << "affskel-server: " << one_line(message) << '\n';
  }
}

void Console::note(const std::string& message) const {
  if (!json_) std::cerr << "affskel-server: " << message << '\n';
}

}  // namespace affskel::server
