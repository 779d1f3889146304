#pragma once

#include <grpcpp/support/status.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "access/identity.h"
#include "access/token.h"

namespace affskel::server {

/// Which of the two services a call is for.
enum class Side { kClient, kWorker };

/// The calls of both services.
enum class Method {
  kSubmitJob,
  kGetJob,
  kListJobs,
  kWatchJob,
  kCancelJob,
  kResumeJob,
  kPinJob,
  kUnpinJob,
  kSetStance,
  kDeleteJob,
  kListJobEvents,
  kVerifyJob,
  kFetchArtifact,
  kGetServerInfo,
  kLeaseTask,
  kRenewLease,
  kReportErosion,
  kCompleteTask,
  kFailTask,
  kReturnLease,
  kFetchInput,
};

/// Which roles may make a call.
struct MethodRule {
  Method method;
  const char* name;  ///< as the contract has it
  Side side;
  bool user;
  bool worker;
  bool admin;
};

/// One row for each method.  A method without one may not be called.
std::span<const MethodRule> method_rules();

/// @throws std::logic_error for a method without a row.
const MethodRule& rule_of(Method method);

/// The jobs that a role sees.
enum class Jobs { kNone, kOwn, kAll };

/// A role without a row sees no job.
Jobs jobs_of(v1::Role role);

/// What is known of a caller before anything is decided.
struct Attempt {
  bool several_tokens = false;     ///< it shows more than one: others on the way may have judged by another
  bool has_token = false;          ///< it shows one,
  std::optional<TokenRow> token;   ///< which is this; absent = it is not known here
  std::int64_t now_ms = 0;         ///< against which the token's times are held
  bool needs_token = false;        ///< nothing else identifies the caller
  bool needs_certificate = false;  ///< the server asks for client certificates on this transport,
  bool has_certificate = false;    ///< and it has shown one that is good
  v1::Role role = v1::ROLE_UNSPECIFIED;
  const MethodRule* method = nullptr;
};

/// Why a call is refused.
struct AccessRule {
  const char* name;
  bool (*refuses)(const Attempt&);
  grpc::StatusCode code;
  std::string (*message)(const Attempt&);
};

/// In the order in which they are asked; the first that refuses answers.
std::span<const AccessRule> access_rules();

/// OK, or the answer of the first rule that refuses.
grpc::Status decide(const Attempt& attempt);

}  // namespace affskel::server
