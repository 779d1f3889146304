#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "affskel/v1/types.pb.h"
#include "client/cli/console.h"

namespace affskel::client {

/// Columns of the terminal behind a descriptor; 0 = it is none, or does not tell.
unsigned terminal_columns(int descriptor);

/// The line without colours, at most `width` columns: stage, bar, share and number of directions done, rate,
/// time left.  Its length does not change as long as the total and the reason to wait do not.
/// @param per_second directions, 0 = not known yet.
std::string progress_bar(const v1::Job& job, double per_second, int width);

/// The same for logs, without a bar.
std::string progress_line(const v1::Job& job, double per_second);

/// Shows the progress of one job on the console: a bar that is redrawn in place on a terminal, otherwise a
/// plain line when the stage or state changes and at tenths of the directions, at most one a second; nothing
/// when quiet.
class ProgressView {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param now replaceable in tests.
  explicit ProgressView(Console& console, std::function<Clock::time_point()> now = Clock::now);
  ~ProgressView();

  void update(const v1::Job& job);

 private:
  double measure(const v1::Job& job);
  void print(const v1::Job& job, double per_second);

  Console& console_;
  std::function<Clock::time_point()> now_;
  // The rate is smoothed over the differences between updates, on the client's own clock.
  std::optional<Clock::time_point> last_time_;
  std::uint64_t last_done_ = 0;
  v1::JobStage last_stage_ = v1::JOB_STAGE_UNSPECIFIED;
  double rate_ = 0;
  std::optional<Clock::time_point> last_print_;
  std::string last_label_;
  std::uint64_t last_tenth_ = 0;
};

}  // namespace affskel::client
