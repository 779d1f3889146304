#include "access/rules.h"

#include <gtest/gtest.h>

#include <iterator>
#include <set>
#include <string>

#include "affskel/v1/client_service.grpc.pb.h"
#include "affskel/v1/worker_service.grpc.pb.h"

namespace affskel::server {
namespace {

TEST(MethodRules, EveryCallOfBothServicesHasOneRow) {
  std::multiset<std::string> expected, found;
  for (const char* service : {"affskel.v1.ErosionService", "affskel.v1.WorkerService"}) {
    const auto* descriptor = v1::SubmitJobRequest::descriptor()->file()->pool()->FindServiceByName(service);
    ASSERT_NE(descriptor, nullptr);
    for (int i = 0; i < descriptor->method_count(); ++i) expected.insert(descriptor->method(i)->name());
  }
  for (const MethodRule& rule : method_rules()) {
    found.insert(rule.name);
    EXPECT_EQ(&rule_of(rule.method), &rule);
  }
  EXPECT_EQ(found, expected);
}

TEST(MethodRules, UsersCallOneServiceAndWorkersTheOther) {
  for (const MethodRule& rule : method_rules()) {
    EXPECT_TRUE(rule.admin) << rule.name;
    EXPECT_EQ(rule.user, rule.side == Side::kClient) << rule.name;
    EXPECT_EQ(rule.worker, rule.side == Side::kWorker) << rule.name;
  }
}

TEST(JobsRules, EachRoleSeesItsJobs) {
  EXPECT_EQ(jobs_of(v1::ROLE_USER), Jobs::kOwn);
  EXPECT_EQ(jobs_of(v1::ROLE_ADMIN), Jobs::kAll);
  EXPECT_EQ(jobs_of(v1::ROLE_WORKER), Jobs::kNone);
  EXPECT_EQ(jobs_of(v1::ROLE_UNSPECIFIED), Jobs::kNone);
}

/// A call that nothing is wrong with.
Attempt good() {
  Attempt attempt;
  attempt.has_token = true;
  attempt.token = TokenRow{};
  attempt.needs_certificate = true;
  attempt.has_certificate = true;
  attempt.role = v1::ROLE_USER;
  attempt.method = &rule_of(Method::kGetJob);
  attempt.now_ms = 1000;
  return attempt;
}

struct Case {
  const char* rule;
  void (*spoil)(Attempt&);
  grpc::StatusCode code;
};

constexpr Case kCases[] = {
    {"no client certificate", [](Attempt& a) { a.has_certificate = false; }, grpc::UNAUTHENTICATED},
    {"several tokens", [](Attempt& a) { a.several_tokens = true; }, grpc::UNAUTHENTICATED},
    {"no token",
     [](Attempt& a) {
       a.has_token = false;
       a.token.reset();
       a.needs_token = true;
     },
     grpc::UNAUTHENTICATED},
    {"unknown token", [](Attempt& a) { a.token.reset(); }, grpc::UNAUTHENTICATED},
    {"revoked token", [](Attempt& a) { a.token->revoked_ms = 999; }, grpc::UNAUTHENTICATED},
    {"expired token", [](Attempt& a) { a.token->expires_ms = 1000; }, grpc::UNAUTHENTICATED},
    {"wrong role", [](Attempt& a) { a.role = v1::ROLE_WORKER; }, grpc::PERMISSION_DENIED},
};

TEST(AccessRules, EachRowRefusesOneFaultAndNoOtherRowDoes) {
  ASSERT_TRUE(decide(good()).ok());
  ASSERT_EQ(access_rules().size(), std::size(kCases));
  for (const Case& one : kCases) {
    Attempt attempt = good();
    one.spoil(attempt);
    for (const AccessRule& rule : access_rules()) {
      EXPECT_EQ(rule.refuses(attempt), std::string(rule.name) == one.rule) << one.rule << " by " << rule.name;
    }
    EXPECT_EQ(decide(attempt).error_code(), one.code) << one.rule;
    EXPECT_NE(decide(attempt).error_message(), "") << one.rule;
  }
}

}  // namespace
}  // namespace affskel::server
