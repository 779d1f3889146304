// Who may ask the service for what.
#include "web/web_service_fixture.h"

namespace affskel::client {
namespace {

TEST_F(WebServiceTest, AKeyOpensThePageOnce) {
  EXPECT_EQ(ask("POST", "/api/session", R"({"key": "guess"})").status, 401);
  EXPECT_EQ(ask("POST", "/api/session", "{}").status, 401);
  EXPECT_EQ(ask("POST", "/api/session", "no object").status, 400);
  const std::string key = json({{"key", web_->new_key()}}).dump();
  const Answer first = ask("POST", "/api/session", key);
  EXPECT_EQ(first.status, 200);
  EXPECT_NE(first.header("Set-Cookie").find("HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_EQ(ask("POST", "/api/session", key).status, 401);
  cookie_ = first.header("Set-Cookie").substr(0, first.header("Set-Cookie").find(';'));
  EXPECT_TRUE(ask("GET", "/api/session").object()["signed_in"]);
  EXPECT_EQ(ask("DELETE", "/api/session").status, 200);
  EXPECT_EQ(ask("GET", "/api/jobs").status, 401);
}

TEST_F(WebServiceTest, NothingElseIsAnsweredBeforeSomebodyIsSignedIn) {
  for (const auto& [method, path] :
       std::vector<std::pair<std::string, std::string>>{{"GET", "/api/jobs"},
                                                        {"GET", "/api/jobs/0123456789ab"},
                                                        {"POST", "/api/jobs"},
                                                        {"DELETE", "/api/jobs/0123456789ab"},
                                                        {"POST", "/api/jobs/0123456789ab/cancel"},
                                                        {"POST", "/api/jobs/0123456789ab/resume"},
                                                        {"POST", "/api/jobs/0123456789ab/results"},
                                                        {"POST", "/api/meshes?name=a.off"},
                                                        {"GET", "/api/meshes/1/lattice?points=5"},
                                                        {"GET", "/api/server"},
                                                        {"GET", "/results/1"},
                                                        {"DELETE", "/api/session"}}) {
    EXPECT_EQ(ask(method, path).status, 401) << method << " " << path;
  }
  EXPECT_FALSE(ask("GET", "/api/session").object()["signed_in"]);
  EXPECT_TRUE(service_.lists.empty()) << "the server was not asked";
}

TEST_F(WebServiceTest, PeopleSignInWithTheirTokens) {
  service_.tokens = {{"Bearer ada's", caller("ada", v1::ROLE_USER)},
                     {"Bearer root's", caller("root", v1::ROLE_ADMIN)}};
  serve(false);
  EXPECT_EQ(ask("GET", "/api/session").object()["mode"], "sign-in");
  for (const char* wrong : {"", "guess", "two words", "line\nend"})
    EXPECT_EQ(ask("POST", "/api/session", json({{"token", wrong}}).dump()).status, 403) << wrong;
  EXPECT_EQ(ask("POST", "/api/session", json({{"key", web_->new_key()}}).dump()).status, 403)
      << "keys are no tokens";
  sign_in("ada's");
  EXPECT_EQ(cookie_.find("ada's"), std::string::npos) << "the token stays here";
  const json ada = ask("GET", "/api/session").object();
  EXPECT_EQ(ada["owner"], "ada");
  EXPECT_EQ(ada["admin"], false);
  EXPECT_EQ(ask("GET", "/api/session").body.find("ada's"), std::string::npos);
  ask("GET", "/api/jobs");
  EXPECT_EQ(service_.listed.owner(), "ada");
  EXPECT_EQ(ask("GET", "/api/server").status, 403);
  sign_in("root's");
  EXPECT_EQ(ask("GET", "/api/server").status, 200);
}

TEST_F(WebServiceTest, ARevokedTokenEndsItsSession) {
  service_.tokens = {{"Bearer ada's", caller("ada", v1::ROLE_USER)},
                     {"Bearer bob's", caller("bob", v1::ROLE_USER)}};
  serve(false);
  sign_in("ada's");
  EXPECT_EQ(ask("GET", "/api/jobs").status, 200);
  service_.tokens.erase("Bearer ada's");
  EXPECT_EQ(ask("GET", "/api/jobs").status, 401);
  service_.tokens["Bearer ada's"] = caller("ada", v1::ROLE_USER);
  EXPECT_EQ(ask("GET", "/api/jobs").status, 401) << "the session has ended";
}

TEST_F(WebServiceTest, NobodySignsInWhereTheServerTakesEverybody) {
  serve(false);
  const Answer answer = ask("POST", "/api/session", json({{"token", "any"}}).dump());
  EXPECT_EQ(answer.status, 403);
  EXPECT_NE(answer.error().find("asks nobody for a token"), std::string::npos);
}

TEST_F(WebServiceTest, OtherOriginsAreRefused) {
  sign_in();
  origin_ = "http://evil.example";
  EXPECT_EQ(ask("POST", "/api/jobs/" + service_.job.id() + "/cancel").status, 403);
  EXPECT_EQ(ask("DELETE", "/api/jobs/" + service_.job.id()).status, 403);
}

TEST_F(WebServiceTest, ResultsAreForTheirSessionAlone) {
  sign_in();
  const Answer answer = ask("POST", "/api/jobs/" + service_.job.id() + "/results", R"({"artefact": "mesh"})");
  const std::string href = answer.object()["href"], first = cookie_;
  EXPECT_EQ(ask("GET", href).status, 200);
  sign_in();
  EXPECT_EQ(ask("GET", href).status, 404);
  cookie_ = first;
  EXPECT_EQ(ask("GET", href).status, 200);
  ask("DELETE", "/api/session");
  EXPECT_EQ(ask("GET", href).status, 401);
}

}  // namespace
}  // namespace affskel::client
