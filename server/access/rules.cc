#include "access/rules.h"

#include <algorithm>
#include <stdexcept>

#include "wire/words.h"

namespace affskel::server {
namespace {

constexpr MethodRule kMethods[] = {
    // method, name, side, user, worker, admin
    {Method::kSubmitJob, "SubmitJob", Side::kClient, true, false, true},
    {Method::kGetJob, "GetJob", Side::kClient, true, false, true},
    {Method::kListJobs, "ListJobs", Side::kClient, true, false, true},
    {Method::kWatchJob, "WatchJob", Side::kClient, true, false, true},
    {Method::kCancelJob, "CancelJob", Side::kClient, true, false, true},
    {Method::kResumeJob, "ResumeJob", Side::kClient, true, false, true},
    {Method::kPinJob, "PinJob", Side::kClient, true, false, true},
    {Method::kUnpinJob, "UnpinJob", Side::kClient, true, false, true},
    {Method::kSetStance, "SetStance", Side::kClient, true, false, true},
    {Method::kDeleteJob, "DeleteJob", Side::kClient, true, false, true},
    {Method::kListJobEvents, "ListJobEvents", Side::kClient, true, false, true},
    {Method::kVerifyJob, "VerifyJob", Side::kClient, true, false, true},
    {Method::kFetchArtifact, "FetchArtifact", Side::kClient, true, false, true},
    {Method::kGetServerInfo, "GetServerInfo", Side::kClient, true, false, true},
    {Method::kLeaseTask, "LeaseTask", Side::kWorker, false, true, true},
    {Method::kRenewLease, "RenewLease", Side::kWorker, false, true, true},
    {Method::kReportErosion, "ReportErosion", Side::kWorker, false, true, true},
    {Method::kCompleteTask, "CompleteTask", Side::kWorker, false, true, true},
    {Method::kFailTask, "FailTask", Side::kWorker, false, true, true},
    {Method::kReturnLease, "ReturnLease", Side::kWorker, false, true, true},
    {Method::kFetchInput, "FetchInput", Side::kWorker, false, true, true},
};

struct JobsRule {
  v1::Role role;
  Jobs jobs;
};

constexpr JobsRule kJobs[] = {
    {v1::ROLE_USER, Jobs::kOwn},
    {v1::ROLE_ADMIN, Jobs::kAll},
};

bool may_call(const MethodRule& method, v1::Role role) {
  return (role == v1::ROLE_USER && method.user) || (role == v1::ROLE_WORKER && method.worker) ||
         (role == v1::ROLE_ADMIN && method.admin);
}

constexpr AccessRule kAccess[] = {
    {"no client certificate", [](const Attempt& a) { return a.needs_certificate && !a.has_certificate; },
     grpc::StatusCode::UNAUTHENTICATED,
     [](const Attempt&) { return std::string("this server asks for a client certificate"); }},
    {"several tokens", [](const Attempt& a) { return a.several_tokens; }, grpc::StatusCode::UNAUTHENTICATED,
     [](const Attempt&) { return std::string("more than one authorization was sent"); }},
    {"no token", [](const Attempt& a) { return a.needs_token && !a.has_token; },
     grpc::StatusCode::UNAUTHENTICATED,
     [](const Attempt&) { return std::string("this server asks for a token (--token-file)"); }},
    {"unknown token", [](const Attempt& a) { return a.has_token && !a.token; },
     grpc::StatusCode::UNAUTHENTICATED,
     [](const Attempt&) { return std::string("the token is none of this server's"); }},
    {"revoked token", [](const Attempt& a) { return a.token && a.token->revoked_ms; },
     grpc::StatusCode::UNAUTHENTICATED,
     [](const Attempt&) { return std::string("the token has been revoked"); }},
    {"expired token", [](const Attempt& a) { return a.token && a.token->is_expired(a.now_ms); },
     grpc::StatusCode::UNAUTHENTICATED, [](const Attempt&) { return std::string("the token has expired"); }},
    {"wrong role", [](const Attempt& a) { return !may_call(*a.method, a.role); },
     grpc::StatusCode::PERMISSION_DENIED,
     [](const Attempt& a) {
       return "the token is a " + wire::word(a.role) + "'s, and " + std::string(a.method->name) +
              " is not for that role; affskel-server token add makes others";
     }},
};

}  // namespace

std::span<const MethodRule> method_rules() {
  return kMethods;
}

const MethodRule& rule_of(Method method) {
  const auto* row = std::find_if(std::begin(kMethods), std::end(kMethods),
                                 [&](const MethodRule& rule) { return rule.method == method; });
  if (row == std::end(kMethods)) throw std::logic_error("a method without a rule");
  return *row;
}

Jobs jobs_of(v1::Role role) {
  const auto* row = std::find_if(std::begin(kJobs), std::end(kJobs),
                                 [&](const JobsRule& rule) { return rule.role == role; });
  return row == std::end(kJobs) ? Jobs::kNone : row->jobs;
}

std::span<const AccessRule> access_rules() {
  return kAccess;
}

grpc::Status decide(const Attempt& attempt) {
  for (const AccessRule& rule : kAccess) {
    if (rule.refuses(attempt)) return {rule.code, rule.message(attempt)};
  }
  return grpc::Status::OK;
}

}  // namespace affskel::server
