#pragma once

#include <cstddef>
#include <string>
#include <vector>

// What the reports of bench and experiments are written with.
namespace affskel::tests {

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// "1 piece", "2 pieces".
std::string count_of(std::size_t count, const char* noun);

/// Seconds as people say them: "14 ms", "0.42 s", "35 min 41 s", "180 h".
std::string duration(double seconds);

/// A row of a Markdown table.
std::string table_row(const std::vector<std::string>& cells);

/// A Markdown table.  Columns after the first are set flush right.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the head

  std::string markdown() const;
};

}  // namespace affskel::tests
