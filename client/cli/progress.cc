#include "client/cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/utf8.h"
#include "client/text/time_text.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

constexpr int kDefaultWidth = 80;
constexpr int kMaxBar = 40;
constexpr std::chrono::seconds kMinSilence{1};  // between plain lines of one stage
constexpr double kSmoothing = 1.5;              // seconds over which the rate forgets

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kDefaultWidth;
}

std::string label(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_RUNNING) return stage_word(job.stage());
  return state_word(job.state());
}

std::string rate_text(double per_second) {
  return per_second < 100 ? base::rounded(per_second, 2) : std::to_string(std::llround(per_second));
}

std::string count_text(const v1::Job& job, const ProgressRate& rate) {
  std::string text =
      std::to_string(job.directions_done()) + "/" + std::to_string(job.directions_total()) + " directions";
  if (rate.directions_per_second > 0) text += ", " + rate_text(rate.directions_per_second) + "/s";
  if (rate.remaining) text += ", " + duration_text(*rate.remaining) + " left";
  return text;
}

std::string reason_text(const v1::Job& job) {
  return job.waiting_reason().empty() ? "" : " (" + job.waiting_reason() + ")";
}

double done_share(const v1::Job& job) {
  if (job.directions_total() == 0) return 0;
  return std::min(1.0, double(job.directions_done()) / double(job.directions_total()));
}

}  // namespace

std::string progress_line(const v1::Job& job, const ProgressRate& rate) {
  if (job.directions_total() == 0) return label(job) + reason_text(job);
  return label(job) + reason_text(job) + ": " + count_text(job, rate);
}

std::string progress_bar(const v1::Job& job, const ProgressRate& rate, int width) {
  std::string head = label(job);
  head.resize(std::max<std::size_t>(head.size(), 9), ' ');
  const std::string tail =
      job.directions_total() > 0 ? count_text(job, rate) + reason_text(job) : reason_text(job);
  const int room = width - static_cast<int>(head.size() + tail.size()) - 5;
  std::string line = head;
  if (room >= 8 && job.directions_total() > 0) {
    const int cells = std::min(room, kMaxBar);
    const int full = static_cast<int>(std::floor(done_share(job) * cells));
    line += " [" + std::string(static_cast<std::size_t>(full), '#') +
            std::string(static_cast<std::size_t>(cells - full), '.') + "]";
  }
  line += " " + tail;
  return std::string(base::truncate_utf8(line, static_cast<std::size_t>(std::max(0, width))));
}

ProgressView::ProgressView(Console& console, std::function<Clock::time_point()> now)
    : console_(console), now_(std::move(now)) {}

ProgressView::~ProgressView() {
  console_.clear_transient();
}

ProgressRate ProgressView::measure(const v1::Job& job) {
  const Clock::time_point now = now_();
  if (last_time_ && job.directions_done() >= last_done_) {
    const double seconds = std::chrono::duration<double>(now - *last_time_).count();
    const double gained = double(job.directions_done() - last_done_);
    if (seconds > 0) {
      const double weight = rate_ > 0 ? 1 - std::exp(-seconds / kSmoothing) : 1;
      rate_ += weight * (gained / seconds - rate_);
    }
  }
  last_time_ = now;
  last_done_ = job.directions_done();
  ProgressRate rate;
  if (job.stage() != v1::JOB_STAGE_ERODE || rate_ < 1e-6) return rate;
  rate.directions_per_second = rate_;
  const double left =
      double(job.directions_total() - std::min(job.directions_done(), job.directions_total())) / rate_;
  if (left > 0 && left < 1e8) rate.remaining = std::chrono::milliseconds(std::llround(1000 * left));
  return rate;
}

void ProgressView::update(const v1::Job& job) {
  if (console_.style().quiet) return;
  const ProgressRate rate = measure(job);
  if (console_.style().terminal) {
    console_.transient(progress_bar(job, rate, terminal_width() - 1));
  } else {
    print(job, rate);
  }
}

void ProgressView::print(const v1::Job& job, const ProgressRate& rate) {
  const std::string now = label(job) + reason_text(job);
  const auto tenth = static_cast<std::uint64_t>(10 * done_share(job));
  const bool news = tenth != last_tenth_ && (!last_print_ || now_() - *last_print_ >= kMinSilence);
  if (now == last_label_ && !news) return;
  last_label_ = now;
  last_tenth_ = tenth;
  last_print_ = now_();
  console_.note(progress_line(job, rate));
}

}  // namespace affskel::client
