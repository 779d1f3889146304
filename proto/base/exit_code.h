#pragma once

#include <array>

namespace affskel::base {

/// What the programs exit with; fixed, scripts rely on it.
enum class ExitCode : int {
  kDone = 0,
  kJobFailed = 1,
  kFaults = kJobFailed,  ///< of affskel-server check
  kUsage = 2,
  kBadInput = 3,
  kNotFound = 4,
  kUnreachable = 5,
  kCancelled = 6,
  kNotAllowed = 7,
  kLimit = 8,
  kInternal = 70,
  kClosedPipe = 141,  ///< as a shell reports SIGPIPE
};

struct ExitCodeRow {
  ExitCode code;
  const char* name;     ///< stable, for errors in JSON
  const char* meaning;  ///< for people
};

inline constexpr std::array<ExitCodeRow, 11> kExitCodes = {{
    {ExitCode::kDone, "DONE", "done"},
    {ExitCode::kJobFailed, "JOB_FAILED", "the job failed"},
    {ExitCode::kUsage, "USAGE", "usage"},
    {ExitCode::kBadInput, "BAD_INPUT", "bad input file"},
    {ExitCode::kNotFound, "NOT_FOUND", "no such job or artefact"},
    {ExitCode::kUnreachable, "UNREACHABLE", "server unreachable"},
    {ExitCode::kCancelled, "CANCELLED", "cancelled"},
    {ExitCode::kNotAllowed, "NOT_ALLOWED", "not allowed"},
    {ExitCode::kLimit, "LIMIT", "limit reached"},
    {ExitCode::kInternal, "INTERNAL", "internal error"},
    {ExitCode::kClosedPipe, "CLOSED_PIPE", "nobody reads the output any more"},
}};

/// "BAD_INPUT".
constexpr const char* exit_code_name(ExitCode code) {
  for (const ExitCodeRow& row : kExitCodes) {
    if (row.code == code) return row.name;
  }
  return "INTERNAL";
}

}  // namespace affskel::base
