#include "tools/report_text.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace affskel::tests {

std::string format(const char* pattern, ...) {
  va_list values, again;
  va_start(values, pattern);
  va_copy(again, values);
  const int length = std::vsnprintf(nullptr, 0, pattern, values);
  va_end(values);
  std::string text(static_cast<std::size_t>(std::max(0, length)), ' ');
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  return text;
}

std::string count_of(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string duration(double seconds) {
  if (seconds < 0.1) return format("%.0f ms", 1000 * seconds);
  if (seconds < 10) return format("%.2f s", seconds);
  if (seconds < 120) return format("%.0f s", seconds);
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return format("%ld min %ld s", whole / 60, whole % 60);
  if (whole < 10 * 3600) return format("%ld h %ld min", whole / 3600, whole % 3600 / 60);
  return format("%.0f h", seconds / 3600);
}

std::string table_row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

std::string Table::markdown() const {
  std::string text = table_row(head) + "|---|";
  for (std::size_t c = 1; c < head.size(); ++c) text += "--:|";
  text += "\n";
  for (const std::vector<std::string>& cells : rows) text += table_row(cells);
  return text;
}

}  // namespace affskel::tests
