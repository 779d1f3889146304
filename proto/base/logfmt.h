#pragma once

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

namespace affskel::base {

/// One field of a line of the log.
struct LogField {
  /// @param name letters, digits and '_'.
  /// @param text any bytes, wherever they come from.
  LogField(std::string_view name, std::string_view text) : key(name), value(text) {}
  LogField(std::string_view name, std::integral auto number) : key(name), value(std::to_string(number)) {}

  std::string_view key;
  std::string value;
};

/// An entry of the log in logfmt: `event=EVENT key=value ...`.  A value that is empty, or has anything but
/// visible ASCII without '"', '\' and '=', stands in quotes, with the escapes of JSON: so an entry is one
/// line, whatever it quotes, and no peer can write entries or fields of its own.  What is not well-formed
/// UTF-8 becomes U+FFFD.  Fields without a value (no task, no worker) are better left out by
/// the caller.
/// @param event letters, digits and '_': what happened.
std::string logfmt(std::string_view event, std::initializer_list<LogField> fields = {});

/// Appends ` key=value` to such an entry.
void append_field(std::string& entry, const LogField& field);

/// What stands before an entry, for spdlog: time (UTC) and level.
inline constexpr const char* kLogPattern = "time=%Y-%m-%dT%H:%M:%S.%eZ level=%l %v";

}  // namespace affskel::base
