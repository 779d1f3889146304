// Which callers may ask the service for what.
#include "web/web_service_fixture.h"

namespace affskel::client {
namespace {

TEST_F(WebServiceTest, AKeyOpensThePageOnce) {
  EXPECT_EQ(ask("POST", "/api/session", R"({"key": "guess"})").status, 401);
  EXPECT_EQ(ask("POST", "/api/session", "{}").status, 401);
  EXPECT_EQ(ask("POST", "/api/session", "no object").status, 400);
  const std::string key = json({{"key", web_->new_key()}}).dump();
  service_.fails = {grpc::StatusCode::UNAVAILABLE, "away"};
  EXPECT_EQ(ask("POST", "/api/session", key).status, 503) << "which uses no key up";
  service_.fails = grpc::Status::OK;
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

TEST_F(WebServiceTest, WhoTriesTokensIsPutOff) {
  service_.tokens = {{"Bearer ada's", caller("ada", v1::ROLE_USER)}};
  serve(false);
  const auto answer_to = [&](const std::string& token) {
    return ask("POST", "/api/session", json({{"token", token}}).dump());
  };
  for (unsigned i = 0; i < BrakeLimits().free; ++i)
    EXPECT_EQ(answer_to("guess" + std::to_string(i)).status, 403);
  const int looks = service_.infos;
  for (int i = 0; i < 100; ++i) {
    const Answer answer = answer_to("another" + std::to_string(i));
    EXPECT_EQ(answer.status, 429);
    EXPECT_EQ(answer.header("Retry-After"), "1");
  }
  EXPECT_EQ(service_.infos, looks) << "the server is not asked";
  EXPECT_EQ(answer_to("ada's").status, 429) << "and comes again";
}

// Two are looked at at a time, and one more is refused, however many sessions the owner has.
TEST_F(WebServiceTest, WorkIsCountedByOwner) {
  service_.tokens = {{"Bearer ada's", caller("ada", v1::ROLE_USER)},
                     {"Bearer bob's", caller("bob", v1::ROLE_USER)}};
  serve(false);
  std::vector<http::Reception> under_way;
  const auto upload = [&](const std::string& token) {
    sign_in(token);
    auto admitted = web_->admit(request_of("POST", "/api/meshes?name=a.off"));
    if (const auto* refusal = std::get_if<http::Response>(&admitted)) return refusal->status;
    under_way.push_back(std::get<http::Reception>(std::move(admitted)));
    return 200;
  };
  EXPECT_EQ(upload("ada's"), 200);
  EXPECT_EQ(upload("ada's"), 200);
  EXPECT_EQ(upload("ada's"), 429);
  EXPECT_EQ(upload("bob's"), 200);
  EXPECT_EQ(under_way[0].owner, under_way[1].owner);
  EXPECT_NE(under_way[0].owner, under_way[2].owner);
  under_way.erase(under_way.begin());
  EXPECT_EQ(upload("ada's"), 200) << "when the first has ended";
}

}  // namespace
}  // namespace affskel::client
