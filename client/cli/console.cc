#include "client/cli/console.h"

#include <cerrno>
#include <nlohmann/json.hpp>
#include <ostream>

#include "base/mutex.h"
#include "base/standard_streams.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

constexpr const char* kRed = "\033[31m";
constexpr const char* kYellow = "\033[33m";
constexpr const char* kCyan = "\033[36m";
constexpr const char* kClearLine = "\r\033[K";
constexpr const char* kReset = "\033[0m";

// Invalid UTF-8 (file names may hold any bytes) must not make the output fail.
std::string dump(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

// @param error_number 0: not known.
[[noreturn]] void not_written(int error_number) {
  if (base::standard_output_is_closed()) throw error_from_errno(EBADF, "cannot write", "standard output");
  const base::OutputError error(error_number);
  throw ClientError(error.code(), error.what());
}

}  // namespace

void Console::erase_transient() {
  if (transient_shown_) err_ << kClearLine << std::flush;
  transient_shown_ = false;
}

void Console::line(const char* colour, std::string_view label, std::string_view text) {
  const base::MutexLock lock(mutex_);
  erase_transient();
  if (!label.empty()) err_ << (style_.colour ? colour : "") << label << (style_.colour ? kReset : "") << ' ';
  err_ << text << '\n' << std::flush;
}

// A stream does not keep why it failed, but the failed call has just left it in errno.
void Console::write_out(std::string_view text) {
  errno = 0;
  out_ << text << std::flush;
  if (out_ || errno == 0) return;
  not_written(errno);
}

void Console::result(std::string_view text) {
  if (style_.json) return;
  const base::MutexLock lock(mutex_);
  erase_transient();
  write_out(text);
}

void Console::document(const ordered_json& value) {
  if (!style_.json) return;
  const base::MutexLock lock(mutex_);
  write_out(dump(value) + '\n');
}

void Console::transient(std::string_view text) {
  const base::MutexLock lock(mutex_);
  err_ << kClearLine << (style_.colour ? kCyan : "") << printable(text) << (style_.colour ? kReset : "")
       << std::flush;
  transient_shown_ = true;
}

void Console::clear_transient() {
  const base::MutexLock lock(mutex_);
  erase_transient();
}

void Console::note(std::string_view text) {
  if (!style_.quiet) line("", "", printable(text));
}

void Console::warning(std::string_view text) {
  line(kYellow, "warning:", printable(text));
}

void Console::error(const ClientError& error) {
  if (error.exit_code() == ExitCode::kClosedPipe) return;
  if (!style_.json) return line(kRed, "error:", printable(error.for_people()));
  ordered_json body = {{"code", exit_code_name(error.exit_code())}, {"message", error.what()}};
  if (!error.file().empty()) body["file"] = error.file();
  if (error.line() > 0) body["line"] = error.line();
  line("", "", dump({{"error", body}}));
}

void Console::finish() {
  const base::MutexLock lock(mutex_);
  write_out("");
  if (!out_) not_written(0);
}

}  // namespace affskel::client
