#include "client/base/error.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <sstream>

#include "client/cli/console.h"
#include "client/connection/call_errors.h"

namespace affskel::client {
namespace {

ExitCode exit_for(grpc::StatusCode code) {
  return error_from_status({code, "cause"}, "unix:/s").exit_code();
}

TEST(ErrorFromStatus, MapsToExitCodes) {
  using grpc::StatusCode;
  EXPECT_EQ(exit_for(StatusCode::INVALID_ARGUMENT), ExitCode::kUsage);
  EXPECT_EQ(exit_for(StatusCode::ALREADY_EXISTS), ExitCode::kUsage);
  EXPECT_EQ(exit_for(StatusCode::NOT_FOUND), ExitCode::kNotFound);
  EXPECT_EQ(exit_for(StatusCode::UNAVAILABLE), ExitCode::kUnreachable);
  EXPECT_EQ(exit_for(StatusCode::DEADLINE_EXCEEDED), ExitCode::kUnreachable);
  EXPECT_EQ(exit_for(StatusCode::CANCELLED), ExitCode::kUnreachable);
  EXPECT_EQ(exit_for(StatusCode::DATA_LOSS), ExitCode::kNotFound);
  EXPECT_EQ(exit_for(StatusCode::PERMISSION_DENIED), ExitCode::kNotAllowed);
  EXPECT_EQ(exit_for(StatusCode::UNAUTHENTICATED), ExitCode::kNotAllowed);
  EXPECT_EQ(exit_for(StatusCode::FAILED_PRECONDITION), ExitCode::kNotAllowed);
  EXPECT_EQ(exit_for(StatusCode::RESOURCE_EXHAUSTED), ExitCode::kLimit);
  EXPECT_EQ(exit_for(StatusCode::INTERNAL), ExitCode::kInternal);
  EXPECT_EQ(exit_for(StatusCode::UNKNOWN), ExitCode::kInternal);
  EXPECT_EQ(error_from_status({StatusCode::FAILED_PRECONDITION, "x"}, "s", ExitCode::kNotFound).exit_code(),
            ExitCode::kNotFound);
}

TEST(ErrorFromStatus, NamesTheServerThatCannotBeReached) {
  const ClientError error = error_from_status({grpc::StatusCode::UNAVAILABLE, "no such file"}, "unix:/run/x");
  EXPECT_NE(std::string(error.what()).find("unix:/run/x"), std::string::npos);
  EXPECT_NE(std::string(error.what()).find("no such file"), std::string::npos);
}

TEST(ExitCodes, AreTheFixedNumbers) {
  EXPECT_EQ(static_cast<int>(ExitCode::kDone), 0);
  EXPECT_EQ(static_cast<int>(ExitCode::kJobFailed), 1);
  EXPECT_EQ(static_cast<int>(ExitCode::kUsage), 2);
  EXPECT_EQ(static_cast<int>(ExitCode::kBadInput), 3);
  EXPECT_EQ(static_cast<int>(ExitCode::kNotFound), 4);
  EXPECT_EQ(static_cast<int>(ExitCode::kUnreachable), 5);
  EXPECT_EQ(static_cast<int>(ExitCode::kCancelled), 6);
  EXPECT_EQ(static_cast<int>(ExitCode::kNotAllowed), 7);
  EXPECT_EQ(static_cast<int>(ExitCode::kLimit), 8);
  EXPECT_EQ(static_cast<int>(ExitCode::kInternal), 70);
  EXPECT_EQ(static_cast<int>(ExitCode::kClosedPipe), 141);
}

TEST(ErrorFromCore, TellsThePlaceOnce) {
  const core::CoreError core(core::CoreError::Code::kBadInput, "line 7: vertex 3 has 2 numbers", 7);
  const ClientError error = error_from_core(core, "a.off");
  EXPECT_EQ(error.exit_code(), ExitCode::kBadInput);
  EXPECT_EQ(error.for_people(), "a.off:7: vertex 3 has 2 numbers");
  EXPECT_EQ(error_from_core(core, "").exit_code(), ExitCode::kUsage);
  const core::CoreError limit(core::CoreError::Code::kLimit, "too many");
  EXPECT_EQ(error_from_core(limit, "a.off").exit_code(), ExitCode::kLimit);
}

TEST(ErrorFromErrno, TellsFullDisksAndForbiddenPlaces) {
  EXPECT_EQ(error_from_errno(ENOSPC, "cannot write", "f").exit_code(), ExitCode::kLimit);
  EXPECT_EQ(error_from_errno(EPIPE, "cannot write", "f").exit_code(), ExitCode::kClosedPipe);
  EXPECT_EQ(error_from_errno(EACCES, "cannot write", "f").exit_code(), ExitCode::kNotAllowed);
  EXPECT_EQ(error_from_errno(ENOENT, "cannot write", "f").exit_code(), ExitCode::kUsage);
  EXPECT_EQ(error_from_errno(ENOENT, "cannot write", "f").for_people(),
            "f: cannot write: No such file or directory");
  const ClientError full = error_from_file(base::FileError(ENOSPC, "cannot write", "f"));
  EXPECT_EQ(full.exit_code(), ExitCode::kLimit);
  EXPECT_EQ(full.file(), "f");
  EXPECT_EQ(full.for_people(), "f: cannot write: No space left on device");
}

TEST(Console, JsonErrorsAreOneObjectWithPlace) {
  std::ostringstream out, err;
  ConsoleStyle style;
  style.json = true;
  Console console(out, err, style);
  console.error(ClientError(ExitCode::kBadInput, "bad \"number\"", "a\xff.off", 7));
  EXPECT_EQ(
      err.str(),
      "{\"error\":{\"code\":\"BAD_INPUT\",\"message\":\"bad \\\"number\\\"\",\"file\":\"a\xef\xbf\xbd.off\","
      "\"line\":7}}\n");
  EXPECT_EQ(out.str(), "");
}

TEST(Console, KeepsControlCharactersFromTheTerminal) {
  std::ostringstream out, err;
  Console console(out, err, {});
  console.note("job \x1b[31mred\x7f");
  EXPECT_EQ(err.str(), "job ?[31mred?\n");
}

TEST(Console, QuietDropsNotesButNotWarnings) {
  std::ostringstream out, err;
  ConsoleStyle style;
  style.quiet = true;
  Console console(out, err, style);
  console.note("a note");
  console.warning("a warning");
  EXPECT_EQ(err.str(), "warning: a warning\n");
}

TEST(Console, ALineReplacesTheTransientOne) {
  std::ostringstream out, err;
  ConsoleStyle style;
  style.terminal = true;
  Console console(out, err, style);
  console.transient("50 %");
  console.note("hello");
  console.note("again");
  EXPECT_EQ(err.str(), "\r\033[K50 %\r\033[Khello\nagain\n");
}

TEST(Console, SaysNothingOfAPipeThatNobodyReads) {
  std::ostringstream out, err;
  Console console(out, err, {});
  console.error(error_from_errno(EPIPE, "cannot write", "f"));
  EXPECT_EQ(err.str(), "");
}

TEST(Console, NoticesThatStandardOutputIsGone) {
  std::ostringstream out, err;
  Console console(out, err, {});
  out.setstate(std::ios::badbit);
  EXPECT_THROW(console.finish(), ClientError);
}

}  // namespace
}  // namespace affskel::client
