#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "base/mutex.h"
#include "client/base/error.h"

namespace affskel::client {

struct ConsoleStyle {
  bool json = false;         ///< results and errors as JSON documents
  bool quiet = false;        ///< no notes and no progress; warnings and errors stay
  bool terminal = false;     ///< standard error is a terminal: progress bars
  bool colour = false;       ///< ANSI colours on standard error
  bool out_colour = false;   ///< ANSI colours on standard output
  unsigned out_columns = 0;  ///< of the terminal there; 0 = none
};

/// Results go to `out`, everything for people to `err`.  Whatever writes to `out` throws ClientError
/// kClosedPipe when its reader has gone.  Notes may come from any thread, everything else from one.
class Console {
 public:
  Console(std::ostream& out, std::ostream& err, const ConsoleStyle& style)
      : out_(out), err_(err), style_(style) {}

  const ConsoleStyle& style() const { return style_; }
  /// Text for standard output; dropped in JSON mode, where `document` tells all.
  void result(std::string_view text);
  /// A JSON document on one line of standard output; dropped outside JSON mode.
  void document(const nlohmann::ordered_json& value);

  /// A line that the next one on standard error replaces: progress on a terminal.
  void transient(std::string_view text);
  void clear_transient();

  void note(std::string_view text);
  void warning(std::string_view text);
  /// Nothing for kClosedPipe: the reader has closed the pipe.
  void error(const ClientError& error);

  /// @throws ClientError when standard output did not take everything (disk full).
  void finish();

 private:
  void write_out(std::string_view text) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void line(const char* colour, std::string_view label, std::string_view text);
  void erase_transient() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  base::Mutex mutex_;  // of both streams
  std::ostream& out_ ABSL_GUARDED_BY(mutex_);
  std::ostream& err_ ABSL_GUARDED_BY(mutex_);
  ConsoleStyle style_;
  bool transient_shown_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace affskel::client
