#include "client/web/web_service.h"

#include <filesystem>
#include <regex>

#include "client/operations/job_notices.h"
#include "client/view/page.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "sample_data.h"
#include "web/web_service_fixture.h"

namespace affskel::client {
namespace {

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

TEST_F(WebServiceTest, SaysWhatIsNotOffered) {
  sign_in();
  EXPECT_EQ(ask("GET", "/api/nothing").status, 404);
  EXPECT_EQ(ask("GET", "/api/jobs/a/b/cancel").status, 404);
  EXPECT_EQ(ask("GET", "/page.html").status, 404);
  const Answer put = ask("PUT", "/api/jobs");
  EXPECT_EQ(put.status, 405);
  EXPECT_EQ(put.header("Allow"), "GET, HEAD, POST");
  EXPECT_EQ(ask("HEAD", "/api/jobs").status, 200);
  EXPECT_EQ(ask("HEAD", "/api/archives").status, 405);
  EXPECT_EQ(ask("GET", "/api/jobs/%FF").status, 400);
}

TEST_F(WebServiceTest, ListsJobsAndSaysWhetherThereAreMore) {
  sign_in();
  service_.jobs = 3;
  service_.job.add_done_positions()->set_end(12);
  json listed = ask("GET", "/api/jobs?limit=2").object();
  EXPECT_EQ(listed["jobs"].size(), 2u);
  EXPECT_TRUE(listed["more"]);
  EXPECT_EQ(listed["jobs"][0]["state"], "done");
  EXPECT_EQ(listed["jobs"][0]["directions_total"], 12);
  EXPECT_TRUE(listed["jobs"][0]["done_positions"].empty()) << "may be long";
  EXPECT_EQ(service_.listed.owner(), "me");
  service_.jobs = 2;
  listed = ask("GET", "/api/jobs?limit=2&everybody=1").object();
  EXPECT_FALSE(listed["more"]);
  EXPECT_EQ(service_.listed.owner(), "");
  for (const char* limit : {"0", "1001", "-1", "x", "1e2"})
    EXPECT_EQ(ask("GET", std::string("/api/jobs?limit=") + limit).status, 400) << limit;
}

TEST_F(WebServiceTest, AnArchiveHoldsTheFilesOfJobs) {
  sign_in();
  service_.job.set_name("body");
  const std::string id = service_.job.id();
  const json made = ask("POST", "/api/archives", R"({"jobs": [")" + id + R"(", ")" + id + R"("]})").object();
  EXPECT_EQ(made["name"], "affskel.zip");
  const Answer sent = ask("GET", made["href"]);
  EXPECT_EQ(sent.body.substr(0, 2), "PK");
  EXPECT_EQ(made["size"], sent.body.size());
  for (const std::string folder : {"body/", "body-2/"}) {
    for (const char* file : {"body.field.vti", "body.skeleton.vtp", "body.skeleton.ply", "body.off"})
      EXPECT_NE(sent.body.find(folder + file), std::string::npos) << folder << file;
  }
  EXPECT_EQ(ask("POST", "/api/archives", R"({"jobs": []})").status, 400);
  EXPECT_EQ(ask("POST", "/api/archives", R"({"jobs": [7]})").status, 400);
  EXPECT_EQ(ask("POST", "/api/archives", R"({"jobs": ["000000"]})").status, 404);
  json many = {{"jobs", json::array()}};
  for (int i = 0; i < 101; ++i) many["jobs"].push_back(id);
  EXPECT_EQ(ask("POST", "/api/archives", many.dump()).status, 507);
}

TEST_F(WebServiceTest, TellsOfADoneJobTheWarningsThatTheCommandLineTells) {
  sign_in();
  service_.job.mutable_quality()->set_advice("most of it is flat");
  service_.job.mutable_prepared()->set_points(1500);
  const std::string job = "/api/jobs/" + service_.job.id();
  const json warnings = ask("GET", job).object()["warnings"];
  const Notices notices = end_notices(service_.job);
  ASSERT_EQ(notices.size(), 2u);
  ASSERT_EQ(warnings.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(warnings[n]["code"], notices[n].code);
    EXPECT_EQ(warnings[n]["message"], notices[n].message);
  }
  service_.job.set_state(v1::JOB_STATE_RUNNING);
  EXPECT_FALSE(ask("GET", job).object().contains("warnings"));
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

TEST_F(WebServiceTest, KeepsAJobAndTellsWhatHappenedToIt) {
  sign_in();
  const std::string job = "/api/jobs/" + service_.job.id();
  EXPECT_EQ(ask("POST", job + "/pin").object()["pinned"], true);
  EXPECT_TRUE(service_.job.pinned());
  EXPECT_EQ(ask("POST", job + "/unpin").object()["pinned"], false);
  EXPECT_FALSE(service_.job.pinned());
  EXPECT_EQ(ask("POST", job + "/stance", R"({"stance": "y,-x"})").object()["stance"],
            json({{"up", "y"}, {"front", "minus-x"}}));
  EXPECT_EQ(service_.job.stance().front(), v1::AXIS_DIRECTION_MINUS_X);
  EXPECT_EQ(ask("POST", job + "/stance", R"({"stance": "y,y"})").status, 400);
  EXPECT_EQ(ask("POST", job + "/stance", R"({"stance": "shape"})").status, 200);
  EXPECT_FALSE(service_.job.has_stance());
  v1::JobEvent& event = *service_.events.add_events();
  event.set_number(7);
  event.set_event("lease_lost");
  event.set_worker("w1");
  const json events = ask("GET", job + "/events").object()["events"];
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0]["number"], 7);
  EXPECT_EQ(events[0]["event"], "lease_lost");
  EXPECT_EQ(events[0]["worker"], "w1");
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
  const json open = uploaded("a.obj", "vn 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(open["facts"]["notes"][0]["message"], "passed over 1 row of vn (normals)");
}

TEST_F(WebServiceTest, ComputesNothingForWhoHasGone) {
  sign_in();
  const std::string mesh = uploaded("cube.off", mesh_)["mesh"];
  gone_.request_stop();
  EXPECT_EQ(ask("POST", "/api/meshes?name=a.off", mesh_).error(), "stopped before the end");
  EXPECT_EQ(ask("GET", "/api/meshes/" + mesh + "/lattice?points=8000").error(), "stopped before the end");
}

TEST_F(WebServiceTest, SaysThatMendingMetItsTime) {
  serve(true, std::chrono::nanoseconds(1));
  sign_in();
  const Answer refused = ask("POST", "/api/meshes?name=a.off&repair=wrap", mesh_);
  EXPECT_EQ(refused.status, 507);
  EXPECT_EQ(
      refused.error(),
      "reading, mending and checking it takes more than 1 s of processor time (--repair-limit of affskel-client web)");
}

// An image of voxels is asked for the value at its surface, and is a mesh from then on.
TEST_F(WebServiceTest, TakesImagesOfVoxels) {
  sign_in();
  std::string image =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\nspacings: 100 100 100\nencoding: raw\n\n";
  for (int i = 0; i < 512; ++i) {
    const auto inner = [](int n) { return n % 8 > 1 && n % 8 < 6; };
    image += static_cast<char>(inner(i) && inner(i / 8) && inner(i / 64) ? 200 : 0);
  }
  EXPECT_NE(
      ask("POST", "/api/meshes?name=ct.nrrd", image).object()["error"].get<std::string>().find("isovalue"),
      std::string::npos);
  EXPECT_EQ(ask("POST", "/api/meshes?name=ct.nrrd&isovalue=x", image).status, 400);
  EXPECT_NE(ask("POST", "/api/meshes?name=a.stl", "").object()["error"].get<std::string>().find("empty"),
            std::string::npos);
  const json mesh = ask("POST", "/api/meshes?name=ct.nrrd&isovalue=100", image).object();
  EXPECT_EQ(mesh["facts"]["notes"][0]["code"], "ISOSURFACE");
  EXPECT_NEAR(mesh["facts"]["volume"].get<double>() / 64e6, 1, 0.1);
  ask("POST", "/api/jobs", json{{"mesh", mesh["mesh"]}, {"spacing", 50}, {"name", "ct"}}.dump());
  EXPECT_EQ(service_.mesh.substr(0, 4), "OFF\n");
}

TEST_F(WebServiceTest, TellsWhatIsWrongWithAMeshAndWhere) {
  sign_in();
  const json open = uploaded("open.off", tests::read_file(dir_ / "open.off"));
  EXPECT_FALSE(open.contains("mesh"));
  EXPECT_FALSE(open["facts"]["computable"]);
  EXPECT_EQ(open["facts"]["defects"][0]["code"], "open-edges");
  EXPECT_TRUE(open["facts"]["flat"]) << "a triangle";
  EXPECT_TRUE(open.contains("picture"));
  const Answer turned = ask("POST", "/api/meshes/view?name=open.off", tests::read_file(dir_ / "open.off"));
  EXPECT_NE(ask("GET", turned.object()["href"]).body.find("open.off"), std::string::npos);
  core::Mesh cube = core::make_box(2000, 2000, 2000, 4);
  cube.triangles.pop_back();
  EXPECT_FALSE(uploaded("o.off", core::write_off(cube))["facts"].contains("flat"));
  for (const char* how : {"auto", "fill", "wrap"}) {
    const json repaired =
        ask("POST", std::string("/api/meshes?name=o.off&repair=") + how, core::write_off(cube)).object();
    EXPECT_TRUE(repaired.contains("mesh")) << how << repaired;
    EXPECT_EQ(repaired["facts"]["notes"][0]["code"], "filled-holes");
    EXPECT_NEAR(repaired["facts"]["volume"].get<double>() / 8e9, 1, 0.01) << how;
    EXPECT_EQ(repaired["advice"].size(), how == std::string("wrap") ? 1U : 0U) << repaired["advice"];
  }
  EXPECT_EQ(ask("POST", "/api/meshes?name=o.off&repair=mend", core::write_off(cube)).status, 400);
  const json bad = uploaded("bad.off", tests::read_file(dir_ / "bad.off"));
  EXPECT_EQ(ask("POST", "/api/meshes/view?name=bad.off", tests::read_file(dir_ / "bad.off")).status, 422);
  EXPECT_EQ(bad["line"], 5);
  EXPECT_NE(uploaded("README.md", "Some words\n")["error"].get<std::string>().find("of no kind that is read"),
            std::string::npos);
  EXPECT_FALSE(bad.contains("facts"));
  EXPECT_EQ(bad.dump().find(std::filesystem::temp_directory_path().string()), std::string::npos)
      << "no paths of the service: " << bad;
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
  EXPECT_EQ(ask("GET", lattice + "?spacing=100&frame=sideways").status, 400);
  EXPECT_NE(ask("GET", lattice + "?spacing=3000").body.find("the mesh measures 2000 x"), std::string::npos)
      << ask("GET", lattice + "?spacing=3000").body;
  EXPECT_EQ(ask("GET", "/api/meshes/unknown/lattice?points=5").status, 404);
  // A plate: few points on many lines, of which one request could take all memory.
  const std::string plate =
      "OFF 8 12 0\n0 0 0\n1000 0 0\n0 1000 0\n1000 1000 0\n0 0 1e-6\n1000 0 1e-6\n0 1000 1e-6\n1000 1000 "
      "1e-6\n"
      "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 "
      "3 7 5\n";
  const json lines = ask("GET", "/api/meshes/" + uploaded("plate.off", plate)["mesh"].get<std::string>() +
                                    "/lattice?spacing=0.3")
                         .object();
  EXPECT_EQ(lines["counted"], false);
}

TEST_F(WebServiceTest, SubmitsTheMeshAsItWasSent) {
  sign_in();
  const std::string mesh = uploaded("cube.off", mesh_)["mesh"];
  json asked = {{"mesh", mesh},      {"spacing", 100},       {"directions", "sphere:100"},
                {"frame", "pca"},    {"minimum", "infimum"}, {"operator", "chords"},
                {"request_id", "r1"}};
  const Answer answer = ask("POST", "/api/jobs", asked.dump());
  EXPECT_EQ(answer.status, 201) << answer.body;
  EXPECT_EQ(answer.object()["id"], service_.job.id());
  EXPECT_EQ(service_.mesh, mesh_);
  EXPECT_EQ(service_.submitted.name(), "cube");
  EXPECT_EQ(service_.submitted.params().sampling().spacing(), 100);
  EXPECT_EQ(service_.submitted.params().directions(), "sphere:100");
  EXPECT_EQ(service_.submitted.params().frame(), v1::FRAME_PCA);
  EXPECT_EQ(service_.submitted.params().minimum(), v1::MINIMUM_INFIMUM);
  EXPECT_EQ(service_.submitted.skeleton().operator_(), v1::OPERATOR_CHORDS);
  EXPECT_EQ(service_.submitted.request_id(), "r1");
  EXPECT_TRUE(service_.submitted.params().repair());
  service_.mesh.clear();
  for (const auto& [member, value] : std::vector<std::pair<std::string, json>>{{"spacing", -1},
                                                                               {"spacing", "wide"},
                                                                               {"spacing", 1e-9},
                                                                               {"directions", "cube:5"},
                                                                               {"frame", "x"},
                                                                               {"minimum", "least"},
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
  v1::TriangleMesh curve = sample_sheet();
  for (int v = 0; v < curve.xyz_size() / 3; ++v) {
    curve.add_area(2);
    curve.add_distance(1);
    curve.add_share(0.1);
  }
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = curve.SerializeAsString();
  int files = 0;
  const json offered = ask("GET", "/api/session").object();
  for (const json& artifact : offered["artefacts"]) {
    for (const std::string format : artifact["formats"]) {
      const Answer answer = made({{"artefact", artifact["name"]}, {"format", format}});
      EXPECT_EQ(answer.status, 200) << artifact["name"] << format << answer.body;
      EXPECT_FALSE(answer.body.empty());
      EXPECT_NE(answer.header("Content-Disposition").find("attachment; filename=\"cube."), std::string::npos);
      ++files;
    }
  }
  EXPECT_EQ(files, 6 + 6 + 7 + 9 + 2 + 7 + 5 + 5);
  EXPECT_EQ(made({{"artefact", "mesh"}, {"format", ".off"}}).body, mesh_);
  EXPECT_EQ(made({{"artefact", "field"}, {"format", ".stl"}}).status, 400);
  EXPECT_EQ(made({{"artefact", "soul"}}).status, 400);
}

// Small pictures stand in the list: drawn once, for users that may see the job.
TEST_F(WebServiceTest, KeepsPicturesThatItHasDrawn) {
  EXPECT_EQ(ask("GET", "/api/jobs/" + service_.job.id() + "/thumbnail").status, 401);
  sign_in();
  const Answer first = ask("GET", "/api/jobs/" + service_.job.id() + "/thumbnail?background=dark");
  EXPECT_EQ(first.status, 200) << first.body;
  EXPECT_EQ(first.header("Content-Type"), "image/png");
  EXPECT_EQ(first.body.substr(1, 3), "PNG");
  service_.fetches.clear();
  EXPECT_EQ(ask("GET", "/api/jobs/" + service_.job.id() + "/thumbnail?background=dark").body, first.body);
  EXPECT_TRUE(service_.fetches.empty());
  EXPECT_NE(ask("GET", "/api/jobs/" + service_.job.id() + "/thumbnail").body, first.body) << "on white";
  EXPECT_FALSE(service_.fetches.empty());
  EXPECT_EQ(ask("GET", "/api/jobs/" + service_.job.id() + "/thumbnail?background=loud").status, 400);
  service_.job.set_state(v1::JOB_STATE_RUNNING);
  EXPECT_EQ(ask("GET", "/api/jobs/" + service_.job.id() + "/thumbnail?background=dark").status, 404);
}

TEST_F(WebServiceTest, WordsTheContractForThePage) {
  sign_in();
  const json session = ask("GET", "/api/session").object();
  EXPECT_EQ(session["words"]["operators"]["flux"], "average outward flux");
  EXPECT_EQ(session["usual"], json({{"operator", "ridge"}, {"frame", "axis"}, {"minimum", "set"}}));
  EXPECT_EQ(session["mesh_files"][0], ".off");
  EXPECT_EQ(session["mesh_files"].back(), ".csv") << "points, for a wrap";
  EXPECT_EQ(session["voxel_files"], json({".nrrd", ".mha", ".nii"})) << "in one file each";
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
  for (const char* drawn : {"picture", "view"})
    EXPECT_EQ(made({{"artefact", drawn}, {"fraction", -0.25}}).status, 400) << drawn;
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

TEST_F(WebServiceTest, TheInteractivePageRunsInASandboxOfItsOwn) {
  sign_in();
  const Answer answer = made({{"artefact", "view"}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.header("Content-Security-Policy"), view_page_policy());
  const std::string policy = view_page_policy();
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_NE(policy.find("sandbox allow-scripts allow-downloads"), std::string::npos);
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
