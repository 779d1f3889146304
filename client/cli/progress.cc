#include "client/cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/number_text.h"
#include "base/utf8.h"
#include "client/text/job_progress.h"
#include "client/text/job_text.h"
#include "client/text/time_text.h"
#include "client/text/words.h"

namespace affskel::client {

unsigned terminal_columns(int descriptor) {
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

namespace {

constexpr int kDefaultWidth = 80;
constexpr int kMaxBar = 40;
constexpr std::chrono::seconds kMinSilence{1};  // between plain lines of one stage
constexpr double kSmoothing = 1.5;              // seconds over which the rate forgets
constexpr double kLeastMeasured = 1;  // seconds: what is done comes in lots, which tell no rate alone

int progress_width() {
  const unsigned columns = terminal_columns(STDERR_FILENO);
  return columns > 0 ? static_cast<int>(columns) : kDefaultWidth;
}

std::string label(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_RUNNING) return stage_word(job.stage());
  return state_word(job.state());
}

std::string rate_text(double per_second) {
  return per_second < 100 ? base::rounded(per_second, 2) : std::to_string(std::llround(per_second));
}

std::string left_text(const v1::Job& job) {
  return job.has_remaining_ms() ? duration_text(std::chrono::milliseconds(job.remaining_ms())) + " left" : "";
}

// At least so many columns, filled up in front, or behind.
std::string to_the_right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}
std::string to_the_left(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string count_text(const v1::Job& job) {
  const JobProgress progress = progress_of(job);
  return std::to_string(progress.done) + "/" + std::to_string(progress.total) + " " + progress.unit;
}

// Rates and times come and go and change their length: each has a place of its own.
std::vector<std::string> steady_fields(const v1::Job& job, double per_second) {
  constexpr std::size_t kShare = 6, kRate = 8, kLeft = 16;  // "123456/s", "23 h 59 min left"
  const JobProgress progress = progress_of(job);
  const std::string total = std::to_string(progress.total);
  const std::string rate = per_second > 0 ? rate_text(per_second) + "/s" : "";
  return {to_the_right(percent_text(job), kShare),
          to_the_right(count_text(job), 2 * total.size() + 2 + progress.unit.size()),
          to_the_right(rate, kRate), to_the_left(left_text(job), kLeft)};
}

std::string reason_text(const v1::Job& job) {
  return job.waiting_reason().empty() ? "" : " (" + job.waiting_reason() + ")";
}

}  // namespace

std::string progress_line(const v1::Job& job, double per_second) {
  std::string text = label(job) + reason_text(job);
  if (job.directions_total() == 0) return text;
  text += ": " + percent_text(job) + ", " + count_text(job);
  if (per_second > 0) text += ", " + rate_text(per_second) + "/s";
  return job.has_remaining_ms() ? text + ", " + left_text(job) : text;
}

std::string progress_bar(const v1::Job& job, double per_second, int width) {
  const std::string head = to_the_left(label(job), 9);
  const bool counts = job.directions_total() > 0;
  std::vector<std::string> fields;
  if (counts) fields = steady_fields(job, per_second);
  std::istringstream reason(reason_text(job));
  for (std::string word; reason >> word;) fields.push_back(word);
  int room = width - static_cast<int>(head.size()) - 3;
  for (const std::string& field : fields) room -= static_cast<int>(field.size()) + 1;
  std::string line = head;
  if (room >= 8 && counts) {
    const int cells = std::min(room, kMaxBar);
    const int full = static_cast<int>(std::floor(progress_of(job).share() * cells));
    line += " [" + std::string(static_cast<std::size_t>(full), '#') +
            std::string(static_cast<std::size_t>(cells - full), '.') + "]";
  }
  // Without the fields behind that find no room: a part of a number would be another one.
  const auto columns = static_cast<std::size_t>(std::max(0, width));
  for (const std::string& field : fields) {
    if (line.size() + 1 + field.find_last_not_of(' ') + 1 > columns) break;
    line += " " + field;
  }
  return std::string(base::truncate_utf8(line, columns));
}

ProgressView::ProgressView(Console& console, std::function<Clock::time_point()> now)
    : console_(console), now_(std::move(now)) {}

ProgressView::~ProgressView() {
  console_.clear_transient();
}

double ProgressView::measure(const v1::Job& job) {
  const Clock::time_point now = now_();
  const std::uint64_t done = progress_of(job).done;
  if (job.stage() != last_stage_) {
    last_time_.reset();
    rate_ = 0;
  }
  const bool follows = last_time_ && done >= last_done_;
  const double seconds = follows ? std::chrono::duration<double>(now - *last_time_).count() : 0;
  if (seconds >= kLeastMeasured) {
    const double weight = rate_ > 0 ? 1 - std::exp(-seconds / kSmoothing) : 1;
    rate_ += weight * (double(done - last_done_) / seconds - rate_);
  }
  if (!follows || seconds >= kLeastMeasured) {
    last_time_ = now;
    last_done_ = done;
  }
  last_stage_ = job.stage();
  const bool counts = job.stage() == v1::JOB_STAGE_ERODE || job.stage() == v1::JOB_STAGE_REFINE;
  // What it did before it ended tells nothing any more.
  return job.state() == v1::JOB_STATE_RUNNING && counts && rate_ >= 1e-6 ? rate_ : 0;
}

void ProgressView::update(const v1::Job& job) {
  if (console_.style().quiet) return;
  const double rate = measure(job);
  if (console_.style().terminal) {
    console_.transient(progress_bar(job, rate, progress_width() - 1));
  } else {
    print(job, rate);
  }
}

void ProgressView::print(const v1::Job& job, double per_second) {
  const std::string now = label(job) + reason_text(job);
  const auto tenth = static_cast<std::uint64_t>(10 * progress_of(job).share());
  const bool news = tenth != last_tenth_ && (!last_print_ || now_() - *last_print_ >= kMinSilence);
  if (now == last_label_ && !news) return;
  last_label_ = now;
  last_tenth_ = tenth;
  last_print_ = now_();
  console_.note(progress_line(job, per_second));
}

}  // namespace affskel::client
