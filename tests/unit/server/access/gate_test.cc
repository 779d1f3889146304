#include "access/gate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <set>

namespace affskel::server {
namespace {

class MadeUpTokens final : public TokenSource {
 public:
  std::optional<TokenRow> find_token(std::string_view token) override {
    const auto found = rows.find(std::string(token));
    return found == rows.end() ? std::nullopt : std::optional(found->second);
  }
  bool has_tokens() override { return !rows.empty(); }
  std::vector<std::int64_t> invalid_tokens(const std::vector<std::int64_t>& ids,
                                           std::int64_t now_ms) override {
    std::vector<std::int64_t> invalid;
    for (const auto& [text, row] : rows) {
      for (const std::int64_t id : ids) {
        if (row.id == id && !row.is_valid(now_ms)) invalid.push_back(id);
      }
    }
    return invalid;
  }
  void note_tokens_used(const std::map<std::int64_t, std::int64_t>& last_used_ms) override {
    noted.push_back(last_used_ms);
  }

  std::map<std::string, TokenRow> rows;
  std::vector<std::map<std::int64_t, std::int64_t>> noted;
};

class GateTest : public testing::Test {
 protected:
  void add(const std::string& token, std::int64_t id, const std::string& owner, v1::Role role) {
    TokenRow row;
    row.id = id;
    row.owner = owner;
    row.role = role;
    tokens_.rows[token] = row;
  }
  static Credentials with_token(const std::string& token) {
    Credentials credentials;
    credentials.authorization = "Bearer " + token;
    return credentials;
  }
  Admission admit(const Credentials& credentials, Method method = Method::kGetJob) {
    return gate_.admit(method, credentials);
  }

  MadeUpTokens tokens_;
  std::int64_t now_ms_ = 1'000'000;
  Gate gate_{tokens_, {false, [this] { return now_ms_; }}};
};

TEST_F(GateTest, ATokenSaysWhoItsHolderIs) {
  add("t", 7, "ada", v1::ROLE_USER);
  const Admission admission = admit(with_token("t"));
  ASSERT_TRUE(admission.status.ok());
  EXPECT_EQ(admission.identity.owner, "ada");
  EXPECT_EQ(admission.identity.role, v1::ROLE_USER);
  EXPECT_EQ(admission.identity.token, 7);
}

TEST_F(GateTest, ATokenGoesBeforeTheUserOnASocket) {
  add("t", 7, "ada", v1::ROLE_WORKER);
  Credentials credentials = with_token("t");
  credentials.uid = geteuid();
  EXPECT_EQ(admit(credentials).status.error_code(), grpc::PERMISSION_DENIED);
  EXPECT_TRUE(admit(credentials, Method::kLeaseTask).status.ok());
}

TEST_F(GateTest, AnUnknownTokenIsNoUserOnASocketEither) {
  Credentials credentials = with_token("stale");
  credentials.uid = geteuid();
  EXPECT_EQ(admit(credentials).status.error_code(), grpc::UNAUTHENTICATED);
}

TEST_F(GateTest, OnASocketTheUserIsTheIdentity) {
  Credentials credentials;
  credentials.uid = geteuid();
  EXPECT_EQ(admit(credentials).identity.role, v1::ROLE_ADMIN);
  EXPECT_EQ(admit(credentials).identity.owner, user_name(geteuid()));
  credentials.uid = 0;
  EXPECT_EQ(admit(credentials).identity.role, v1::ROLE_ADMIN);
  credentials.uid = 4'000'000;  // no account's
  EXPECT_EQ(admit(credentials).identity.role, v1::ROLE_USER);
  EXPECT_EQ(admit(credentials).identity.owner, "uid:4000000");
  EXPECT_EQ(admit(credentials, Method::kLeaseTask).status.error_code(), grpc::PERMISSION_DENIED);
}

TEST_F(GateTest, TcpIsOpenUntilTheFirstTokenAndNeverAgain) {
  const Admission open = admit({});
  ASSERT_TRUE(open.status.ok());
  EXPECT_EQ(open.identity.owner, "");
  EXPECT_EQ(open.identity.role, v1::ROLE_ADMIN);
  add("t", 7, "ada", v1::ROLE_USER);
  EXPECT_EQ(admit({}).status.error_code(), grpc::UNAUTHENTICATED);
  tokens_.rows["t"].revoked_ms = 1;
  EXPECT_EQ(admit({}).status.error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(admit(with_token("t")).status.error_code(), grpc::UNAUTHENTICATED);
}

TEST_F(GateTest, OtherSchemesAreNoTokens) {
  add("t", 7, "ada", v1::ROLE_USER);
  for (const char* text : {"t", "Basic t", "Bearer", "Bearer  t", ""}) {
    Credentials credentials;
    credentials.authorization = text;
    EXPECT_EQ(admit(credentials).status.error_code(), grpc::UNAUTHENTICATED) << text;
  }
}

// RFC 9110: a scheme's name has no case.
TEST_F(GateTest, TheSchemeMayBeWrittenInAnyCase) {
  add("t", 7, "ada", v1::ROLE_USER);
  for (const char* text : {"Bearer t", "bearer t", "BEARER t"}) {
    Credentials credentials;
    credentials.authorization = text;
    EXPECT_TRUE(admit(credentials).status.ok()) << text;
    credentials.several_authorizations = true;
    EXPECT_EQ(admit(credentials).status.error_code(), grpc::UNAUTHENTICATED) << text;
  }
}

TEST_F(GateTest, CertificatesAreAskedOfTcpAlone) {
  Gate gate(tokens_, {true, [this] { return now_ms_; }});
  EXPECT_EQ(gate.admit(Method::kGetJob, {}).status.error_code(), grpc::UNAUTHENTICATED);
  Credentials shown;
  shown.has_certificate = true;
  EXPECT_TRUE(gate.admit(Method::kGetJob, shown).status.ok());
  Credentials local;
  local.uid = geteuid();
  EXPECT_TRUE(gate.admit(Method::kGetJob, local).status.ok());
}

TEST_F(GateTest, TellsOfATokenInUseThatIsGoodNoLongerUntilAMinuteAfterItsLastUse) {
  add("t", 7, "ada", v1::ROLE_USER);
  add("u", 8, "bob", v1::ROLE_USER);
  tokens_.rows["u"].revoked_ms = 1;
  EXPECT_TRUE(gate_.newly_invalid().empty());
  EXPECT_TRUE(admit(with_token("t")).status.ok());
  EXPECT_FALSE(admit(with_token("u")).status.ok());
  EXPECT_TRUE(gate_.newly_invalid().empty());
  tokens_.rows["t"].expires_ms = now_ms_;
  for (int times = 0; times < 2; ++times) EXPECT_EQ(gate_.newly_invalid(), std::vector<std::int64_t>{7});
  now_ms_ += 60'001;
  EXPECT_EQ(gate_.newly_invalid(), std::vector<std::int64_t>{7});
  EXPECT_TRUE(gate_.newly_invalid().empty());
}

TEST_F(GateTest, WritesDownItsUseOnceAMinute) {
  add("t", 7, "ada", v1::ROLE_USER);
  gate_.note_use();
  EXPECT_TRUE(tokens_.noted.empty());
  admit(with_token("t"));
  gate_.note_use();
  ASSERT_EQ(tokens_.noted.size(), 1u);
  EXPECT_EQ(tokens_.noted[0].at(7), now_ms_);
  now_ms_ += 59'000;
  admit(with_token("t"));
  gate_.note_use();
  EXPECT_EQ(tokens_.noted.size(), 1u);
  now_ms_ += 1000;
  gate_.note_use();
  ASSERT_EQ(tokens_.noted.size(), 2u);
  EXPECT_EQ(tokens_.noted[1].at(7), now_ms_ - 1000);
}

}  // namespace
}  // namespace affskel::server
