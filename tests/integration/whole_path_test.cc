// The programs as a user runs them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lab.h"

namespace affskel::integration {
namespace {

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// A client that starts its private server under the lab's directory.
class EmbeddedTest : public testing::Test {
 protected:
  Output client(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), AFFSKEL_CLIENT_BINARY);
    return lab_.run(arguments, {"AFFSKEL_HOME=" + lab_.path("home"), "AFFSKEL_SERVER="});
  }

  void TearDown() override {
    const Output info = client({"--json", "server-info"});
    if (info.exit_code != 0) return;
    kill(nlohmann::json::parse(info.out).at("pid").get<pid_t>(), SIGTERM);
  }

  Lab lab_;
};

TEST_F(EmbeddedTest, MeshInSkeletonOut) {
  ASSERT_EQ(client({"make", "body", "--triangles", "500", "-o", lab_.path("body.off")}).exit_code, 0);
  const Output submitted =
      client({"submit", lab_.path("body.off"), "--points", "8000", "-o", lab_.path("out")});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_EQ(lines(submitted.out), 1U);
  const std::string id = first_line(submitted.out);
  for (const char* name : {"body.field.vti", "body.skeleton.vtp", "body.skeleton.ply"}) {
    EXPECT_TRUE(std::filesystem::exists(lab_.path("out") + "/" + name)) << name;
  }

  const nlohmann::json status = nlohmann::json::parse(client({"--json", "status", "@last"}).out);
  EXPECT_EQ(status.at("id"), id);
  EXPECT_EQ(status.at("state"), "done");
  EXPECT_EQ(status.at("directions_done"), 500);
  const auto points = status.at("prepared").at("points").get<std::size_t>();
  EXPECT_NEAR(static_cast<double>(points), 8000, 800);

  // The field is the one that the core computes in process.
  ASSERT_EQ(client({"fetch", id, "field", "-o", lab_.path("field.csv")}).exit_code, 0);
  ASSERT_EQ(lab_.run({AFFSKEL_WORKER_BINARY, "compute", lab_.path("body.off"), "--points", "8000", "-o",
                      lab_.path("plain.csv")})
                .exit_code,
            0);
  EXPECT_TRUE(lab_.read("field.csv") == lab_.read("plain.csv"));
  EXPECT_EQ(lines(lab_.read("field.csv")), points + 1);

  // The vertices of the job's own skeleton.
  ASSERT_EQ(client({"fetch", id, "skeleton", "-o", lab_.path("own.csv")}).exit_code, 0);
  EXPECT_EQ(lines(lab_.read("own.csv")), status.at("skeleton_points").get<std::size_t>() + 1);

  // Of points, a lower threshold keeps more, a hopeless one none, with a warning.
  const auto published = [&](const std::string& threshold, const std::string& file) {
    return client(
        {"skeleton", id, "--operator", "zucker-hummel", "--threshold", threshold, "-o", lab_.path(file)});
  };
  ASSERT_EQ(published("7", "s7.csv").exit_code, 0);
  ASSERT_EQ(published("6", "s6.csv").exit_code, 0);
  EXPECT_GT(lines(lab_.read("s6.csv")), lines(lab_.read("s7.csv")));
  const Output empty = published("1000", "none.csv");
  EXPECT_EQ(empty.exit_code, 0);
  EXPECT_NE(empty.err.find("threshold"), std::string::npos) << empty.err;

  // The mesh comes back unchanged, and the same submission is answered by the same job.
  ASSERT_EQ(client({"fetch", id, "mesh", "-o", lab_.path("back.off")}).exit_code, 0);
  EXPECT_TRUE(lab_.read("back.off") == lab_.read("body.off"));
  EXPECT_EQ(first_line(client({"submit", lab_.path("body.off"), "--points", "8000"}).out), id);

  EXPECT_EQ(client({"delete", id}).exit_code, 0);
  EXPECT_EQ(client({"status", id}).exit_code, 4);
}

TEST_F(EmbeddedTest, TabOffersTheJobsOfAServerThatHasLeft) {
  const std::string id = [this] {
    const Process server = lab_.server({"--workers", "1"});
    EXPECT_EQ(lab_.client({"make", "box", "--size", "3000,2000,1000", "-o", lab_.path("m.off")}).exit_code,
              0);
    return lab_.submit({"--points", "500"});
  }();
  std::filesystem::rename(lab_.path("data"), lab_.path("home"));
  // The first time, a slow machine may take longer to start the server than a person waits for TAB.
  std::string offered;
  for (int time = 0; time < 30 && offered.empty(); ++time) offered = client({"job-ids"}).out;
  EXPECT_NE(offered.find(id.substr(0, 12) + "\t"), std::string::npos) << offered;
}

TEST_F(EmbeddedTest, ABadMeshIsRefusedWithFileLineAndCause) {
  lab_.write("bad.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 nan 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  const Output refused = client({"--json", "submit", lab_.path("bad.off")});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(refused.out.empty());
  const nlohmann::json error = nlohmann::json::parse(refused.err).at("error");
  EXPECT_EQ(error.at("code"), "BAD_INPUT");
  EXPECT_EQ(error.at("line"), 5);
  EXPECT_EQ(error.at("file"), lab_.path("bad.off"));
}

// Past the client's own check, as another program might.
TEST(WorkerErrors, ABadMeshFailsTheJobAtOnce) {
  const Lab lab;
  const Process server = lab.server({"--workers", "1"});
  lab.write("bad.off", "OFF\n4 3 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");
  const std::string mesh = lab.read("bad.off");
  grpc::ClientContext context;
  v1::SubmitJobResponse response;
  const auto writer = lab.stub().SubmitJob(&context, &response);
  v1::SubmitJobRequest request;
  request.mutable_header()->mutable_params()->mutable_sampling()->set_spacing(0.1);
  request.mutable_header()->set_mesh_bytes(mesh.size());
  const std::string digest = lab.run({"/usr/bin/sha256sum", lab.path("bad.off")}).out.substr(0, 64);
  request.mutable_header()->set_mesh_sha256(digest);
  ASSERT_TRUE(writer->Write(request));
  request.set_data(mesh);
  ASSERT_TRUE(writer->Write(request));
  writer->WritesDone();
  const grpc::Status status = writer->Finish();
  ASSERT_TRUE(status.ok()) << status.error_message();
  const v1::Job job = lab.follow_to_end(response.job().id());
  EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.error().code(), "BAD_INPUT");
  EXPECT_NE(job.error().message().find("open edges"), std::string::npos) << job.error().message();
  EXPECT_EQ(lab.client({"watch", job.id()}).exit_code, 1);
}

TEST(ManyJobs, TwoWorkersFinishThemAll) {
  const Lab lab;
  const Process server = lab.server({"--workers", "2"});
  ASSERT_EQ(lab.client({"make", "torus", "--triangles", "256", "-o", lab.path("t.off")}).exit_code, 0);
  std::vector<std::string> ids;
  for (int i = 0; i < 8; ++i) {
    ids.push_back(first_line(
        lab.client({"submit", lab.path("t.off"), "--points", std::to_string(1000 + 100 * i)}).out));
  }
  for (const std::string& id : ids) EXPECT_EQ(lab.follow_to_end(id).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(lines(lab.client({"--json", "list"}).out), 1U);
}

}  // namespace
}  // namespace affskel::integration
