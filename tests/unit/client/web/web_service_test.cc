#include "client/web/web_service.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "client/view/page.h"
#include "client_fixture.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "test_environment.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

// An answer, its file read.
struct Answer {
  int status = 0;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;

  std::string header(const std::string& name) const {
    for (const auto& [key, value] : headers) {
      if (key == name) return value;
    }
    return "";
  }
  json object() const { return json::parse(body); }
  std::string error() const { return object()["error"]["message"]; }
};

// The service before a server in this process that holds one done job, without a network between them.
class WebServiceTest : public ClientTest {
 protected:
  WebServiceTest() {
    service_.caller = caller("me", v1::ROLE_ADMIN);
    serve(true);
  }

  static v1::Caller caller(const std::string& owner, v1::Role role) {
    v1::Caller made;
    made.set_owner(owner);
    made.set_role(role);
    return made;
  }

  void serve(bool personal) {
    RetryPolicy retry;
    retry.first_pause = std::chrono::milliseconds(1);
    retry.patience = std::chrono::milliseconds(200);
    WebOptions options;
    options.port = 8080;
    options.personal = personal;
    GlobalOptions global;
    global.server = server_.address();
    web_ = std::make_unique<WebService>(Backend(test_environment({{"HOME", dir_.path()}}), global, retry),
                                        options);
  }

  // As a browser sends it from the page.
  Answer ask(const std::string& method, const std::string& target, const std::string& body = "") {
    const auto parsed = parse_target(target);
    HttpRequest request;
    request.method = method;
    request.path = parsed->path;
    request.query = parsed->query;
    request.headers = {{"host", "localhost:8080"}, {"sec-fetch-site", "same-origin"}};
    if (method != "GET") request.headers.emplace_back("origin", origin_);
    if (!cookie_.empty()) request.headers.emplace_back("cookie", cookie_);
    auto admitted = web_->admit(request);
    if (auto* refusal = std::get_if<HttpResponse>(&admitted)) return read(*refusal);
    Reception& reception = std::get<Reception>(admitted);
    if (body.size() > reception.max_bytes) return {413, {}, ""};
    if (reception.file.empty()) {
      request.body = body;
    } else {
      tests::write_file(reception.file, body);
    }
    return read(reception.respond(request));
  }

  // By a token, or by a new key.
  void sign_in(const std::string& token = "") {
    const json asked = token.empty() ? json({{"key", web_->new_key()}}) : json({{"token", token}});
    const Answer answer = ask("POST", "/api/session", asked.dump());
    ASSERT_EQ(answer.status, 200) << answer.body;
    const std::string cookie = answer.header("Set-Cookie");
    cookie_ = cookie.substr(0, cookie.find(';'));
  }

  // Makes a result and fetches it.
  Answer made(const json& asked) {
    const Answer answer = ask("POST", "/api/jobs/" + service_.job.id() + "/results", asked.dump());
    if (answer.status != 201) return answer;
    return ask("GET", answer.object()["href"]);
  }

  json uploaded(const std::string& name, const std::string& bytes) {
    const Answer answer = ask("POST", "/api/meshes?name=" + name, bytes);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return answer.object();
  }

  std::unique_ptr<WebService> web_;
  std::string cookie_, origin_ = "http://localhost:8080";

 private:
  static Answer read(const HttpResponse& response) {
    return {response.status, response.headers,
            response.file.empty() ? response.body : tests::read_file(response.file)};
  }
};

TEST_F(WebServiceTest, ThePageIsForEverybodyAndRunsItsOwnScriptAlone) {
  const Answer page = ask("GET", "/");
  EXPECT_EQ(page.status, 200);
  const std::string policy = page.header("Content-Security-Policy");
  EXPECT_NE(policy.find("default-src 'none'; script-src 'self';"), std::string::npos) << policy;
  EXPECT_EQ(policy.find("unsafe"), std::string::npos) << policy;
  EXPECT_EQ(page.body.find(" style="), std::string::npos);
  EXPECT_FALSE(std::regex_search(page.body, std::regex("<script>|<script [^>]*>[^<]|<style| on[a-z]+=")))
      << "nothing inline";
  // All that it asks for is there.
  std::smatch match;
  int files = 0;
  for (std::string rest = page.body; std::regex_search(rest, match, std::regex("(?:src|href)=\"(/[^\"]+)\""));
       rest = match.suffix()) {
    EXPECT_EQ(ask("GET", match[1]).status, 200) << match[1];
    ++files;
  }
  EXPECT_GE(files, 3);
  EXPECT_EQ(ask("GET", "/page.js").body.find("http://"), std::string::npos);
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
  EXPECT_EQ(cookie_.find("ada"), std::string::npos) << "the token stays here";
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

TEST_F(WebServiceTest, SaysWhatIsNotOffered) {
  sign_in();
  EXPECT_EQ(ask("GET", "/api/nothing").status, 404);
  EXPECT_EQ(ask("GET", "/api/jobs/a/b/cancel").status, 404);
  EXPECT_EQ(ask("GET", "/page.html").status, 404);
  const Answer put = ask("PUT", "/api/jobs");
  EXPECT_EQ(put.status, 405);
  EXPECT_EQ(put.header("Allow"), "GET, POST");
  EXPECT_EQ(ask("GET", "/api/jobs/%FF").status, 400);
}

TEST_F(WebServiceTest, ListsJobsAndSaysWhetherThereAreMore) {
  sign_in();
  service_.jobs = 3;
  json listed = ask("GET", "/api/jobs?limit=2").object();
  EXPECT_EQ(listed["jobs"].size(), 2u);
  EXPECT_TRUE(listed["more"]);
  EXPECT_EQ(listed["jobs"][0]["state"], "done");
  EXPECT_EQ(listed["jobs"][0]["directions_total"], 12);
  EXPECT_FALSE(listed["jobs"][0].contains("done_positions"));
  EXPECT_EQ(service_.listed.owner(), "me");
  service_.jobs = 2;
  listed = ask("GET", "/api/jobs?limit=2&everybody=1").object();
  EXPECT_FALSE(listed["more"]);
  EXPECT_EQ(service_.listed.owner(), "");
  for (const char* limit : {"0", "1001", "-1", "x", "1e2"})
    EXPECT_EQ(ask("GET", std::string("/api/jobs?limit=") + limit).status, 400) << limit;
}

TEST_F(WebServiceTest, PassesOnWhatTheServerSays) {
  sign_in();
  EXPECT_EQ(ask("GET", "/api/jobs/000000").status, 404);
  EXPECT_EQ(ask("GET", "/api/jobs/000000").error(), "no job begins with 000000");
  service_.fails = {grpc::StatusCode::RESOURCE_EXHAUSTED, "1000 jobs of 1000 are queued"};
  const Answer refused = ask("POST", "/api/jobs/" + service_.job.id() + "/resume");
  EXPECT_EQ(refused.status, 507);
  EXPECT_EQ(refused.object()["error"]["code"], "LIMIT");
  EXPECT_EQ(refused.error(), "1000 jobs of 1000 are queued");
}

TEST_F(WebServiceTest, TellsWhatAMeshIs) {
  sign_in();
  const json mesh = uploaded("my%20cube.off", mesh_);
  EXPECT_EQ(mesh["name"], "my cube.off");
  EXPECT_EQ(mesh["facts"]["file"], "my cube.off");
  EXPECT_EQ(mesh["facts"]["triangles"], 12);
  EXPECT_DOUBLE_EQ(mesh["facts"]["volume"], 8e9);
  const Answer picture = ask("GET", mesh["picture"]);
  EXPECT_EQ(picture.header("Content-Type"), "image/png");
  EXPECT_TRUE(picture.body.starts_with("\x89PNG"));
}

TEST_F(WebServiceTest, TellsWhatIsWrongWithAMeshAndWhere) {
  sign_in();
  const json open = uploaded("open.off", tests::read_file(dir_ / "open.off"));
  EXPECT_FALSE(open.contains("mesh"));
  EXPECT_FALSE(open["facts"]["computable"]);
  EXPECT_EQ(open["facts"]["defects"][0]["code"], "open-edges");
  EXPECT_TRUE(open.contains("picture"));
  const Answer bad = ask("POST", "/api/meshes?name=bad.off", tests::read_file(dir_ / "bad.off"));
  EXPECT_EQ(bad.status, 422);
  EXPECT_EQ(bad.object()["error"]["line"], 5);
  EXPECT_EQ(bad.body.find("/tmp"), std::string::npos) << "no paths of the service: " << bad.body;
  service_.max_mesh_bytes = 10;
  sign_in();
  EXPECT_EQ(ask("POST", "/api/meshes?name=a.off", mesh_).status, 413);
}

// A cube of edge 2000: 20^3 points lie at a spacing of 100.
TEST_F(WebServiceTest, CountsPointsForASpacingAndBack) {
  sign_in();
  const std::string lattice =
      "/api/meshes/" + uploaded("c.off", mesh_)["mesh"].get<std::string>() + "/lattice";
  const json by_spacing = ask("GET", lattice + "?spacing=100").object();
  EXPECT_EQ(by_spacing["points"], 8000);
  EXPECT_EQ(by_spacing["counted"], true);
  const json by_points = ask("GET", lattice + "?points=8000").object();
  EXPECT_DOUBLE_EQ(by_points["spacing"], 100);
  EXPECT_EQ(by_points["points"], 8000);
  const json many = ask("GET", lattice + "?points=1000000000").object();
  EXPECT_EQ(many["counted"], false);
  EXPECT_DOUBLE_EQ(many["spacing"], 2);
  for (const char* wrong : {"", "?spacing=0", "?spacing=x", "?points=-5", "?points=1e10", "?spacing=1e999"})
    EXPECT_EQ(ask("GET", lattice + wrong).status, 400) << wrong;
  EXPECT_EQ(ask("GET", lattice + "?spacing=100&frame=sideways").status, 422);
  EXPECT_EQ(ask("GET", "/api/meshes/unknown/lattice?points=5").status, 404);
}

TEST_F(WebServiceTest, SubmitsTheMeshAsItWasSent) {
  sign_in();
  const std::string mesh = uploaded("cube.off", mesh_)["mesh"];
  json asked = {{"mesh", mesh},   {"spacing", 100},       {"directions", "sphere:100"},
                {"frame", "pca"}, {"operator", "chords"}, {"request_id", "r1"}};
  const Answer answer = ask("POST", "/api/jobs", asked.dump());
  EXPECT_EQ(answer.status, 201) << answer.body;
  EXPECT_EQ(answer.object()["id"], service_.job.id());
  EXPECT_EQ(service_.mesh, mesh_);
  EXPECT_EQ(service_.submitted.name(), "cube");
  EXPECT_EQ(service_.submitted.params().sampling().spacing(), 100);
  EXPECT_EQ(service_.submitted.params().directions(), "sphere:100");
  EXPECT_EQ(service_.submitted.params().frame(), v1::FRAME_PCA);
  EXPECT_EQ(service_.submitted.skeleton().operator_(), v1::OPERATOR_CHORDS);
  EXPECT_EQ(service_.submitted.request_id(), "r1");
  EXPECT_TRUE(service_.submitted.params().repair());
  service_.mesh.clear();
  for (const auto& [member, value] : std::vector<std::pair<std::string, json>>{{"spacing", -1},
                                                                               {"spacing", "wide"},
                                                                               {"spacing", 1e-9},
                                                                               {"directions", "cube:5"},
                                                                               {"frame", "x"},
                                                                               {"operator", "x"},
                                                                               {"priority", 10},
                                                                               {"threshold", -1},
                                                                               {"mesh", "unknown"},
                                                                               {"name", 5}}) {
    json wrong = asked;
    wrong[member] = value;
    const int status = ask("POST", "/api/jobs", wrong.dump()).status;
    EXPECT_TRUE(status >= 400 && status != 500) << member << " " << value << ": " << status;
  }
  EXPECT_EQ(service_.mesh, "");
}

TEST_F(WebServiceTest, MakesEveryFormatOfEveryArtefact) {
  sign_in();
  int files = 0;
  for (const json& artifact : ask("GET", "/api/session").object()["artefacts"]) {
    for (const std::string format : artifact["formats"]) {
      const Answer answer = made({{"artefact", artifact["name"]}, {"format", format}});
      EXPECT_EQ(answer.status, 200) << artifact["name"] << format << answer.body;
      EXPECT_FALSE(answer.body.empty());
      EXPECT_NE(answer.header("Content-Disposition").find("attachment; filename=\"cube."), std::string::npos);
      ++files;
    }
  }
  EXPECT_EQ(files, 3 + 3 + 5 + 5 + 7 + 1);
  EXPECT_EQ(made({{"artefact", "mesh"}, {"format", ".off"}}).body, mesh_);
  EXPECT_EQ(made({{"artefact", "field"}, {"format", ".stl"}}).status, 400);
  EXPECT_EQ(made({{"artefact", "soul"}}).status, 400);
}

TEST_F(WebServiceTest, PassesParametersOn) {
  sign_in();
  made({{"artefact", "skeleton"}, {"format", ".csv"}, {"operator", "sobel"}, {"threshold", 5}});
  EXPECT_EQ(service_.fetches.back().skeleton().operator_(), v1::OPERATOR_SOBEL);
  EXPECT_EQ(service_.fetches.back().skeleton().threshold(), 5);
  made({{"artefact", "eroded"}, {"format", ".stl"}, {"fraction", 0.25}});
  EXPECT_EQ(service_.fetches.back().kind(), v1::ARTIFACT_KIND_ERODED_SURFACE);
  EXPECT_EQ(service_.fetches.back().eroded().fraction(), 0.25);
  EXPECT_EQ(made({{"artefact", "eroded"}, {"fraction", 2}}).status, 400);
}

TEST_F(WebServiceTest, FileNamesAreHarmless) {
  sign_in();
  service_.job.set_name("../a\"b\r\n/\xC3\xBC");
  const Answer answer = made({{"artefact", "mesh"}});
  const std::string header = answer.header("Content-Disposition");
  EXPECT_EQ(header,
            "attachment; filename=\"job.._a_b___"
            "__.mesh.off\"; "
            "filename*=UTF-8''job.._a_b___%C3%BC.mesh.off");
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

TEST_F(WebServiceTest, TheInteractivePageRunsInASandboxOfItsOwn) {
  sign_in();
  const Answer answer = made({{"artefact", "view"}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.header("Content-Security-Policy"), view_page_policy());
  const std::string policy = view_page_policy();
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_NE(policy.find("sandbox allow-scripts"), std::string::npos);
  EXPECT_TRUE(answer.header("Content-Disposition").starts_with("inline"));
  EXPECT_NE(answer.body.find("<canvas"), std::string::npos);
}

TEST_F(WebServiceTest, AJobThatIsNotDoneHasNothingToShow) {
  sign_in();
  service_.job = sample_job(v1::JOB_STATE_RUNNING);
  const Answer answer = made({{"artefact", "picture"}});
  EXPECT_EQ(answer.status, 404);
  EXPECT_NE(answer.error().find("5 of 12 directions"), std::string::npos);
}

}  // namespace
}  // namespace affskel::client
