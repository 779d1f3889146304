#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace affskel::chaos {

/// What one fault, or the end of a run, came to.
struct Outcome {
  std::uint64_t injected = 0;
  std::uint64_t without_effect = 0;  ///< it found nothing to disturb; counted, no failure
  std::uint64_t differing = 0;       ///< fields or skeletons unlike the undisturbed ones
  std::uint64_t lost = 0;            ///< acknowledgements that the server does not stand by
  std::uint64_t hangs = 0;           ///< waits that reached their limit
  std::uint64_t unclean = 0;         ///< runs of `check` that found faults
  std::uint64_t deaths = 0;          ///< processes that ended though the fault does not end them
  std::uint64_t recoveries = 0;
  std::chrono::milliseconds recovery{0};  ///< summed over the recoveries

  Outcome& operator+=(const Outcome& other);
  bool good() const { return differing + lost + hangs + unclean + deaths == 0; }
};

/// Outcomes by kind, of all runs, in the order of the kinds' table.
class Tally {
 public:
  void add(const std::string& kind, const Outcome& outcome);
  Outcome total() const;
  /// A Markdown table with a line of totals.
  std::string table() const;

 private:
  struct Row {
    std::string kind;
    Outcome outcome;
  };
  std::vector<Row> rows_;
};

}  // namespace affskel::chaos
