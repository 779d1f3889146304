// Two owners, one with a long queue, on real workers: which is granted what, by the server's log.
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "lab.h"
#include "wire/sha256.h"

namespace affskel::integration {
namespace {

constexpr int kTurnWorkers = 2;
constexpr int kAdasJobs = 200;

class TurnsTest : public testing::Test {
 protected:
  std::string submit_as(const std::string& owner, int seed) {
    grpc::ClientContext context;
    v1::SubmitJobResponse response;
    const auto writer = lab_.stub().SubmitJob(&context, &response);
    v1::SubmitJobRequest message;
    v1::SubmitJobHeader& header = *message.mutable_header();
    header.set_owner(owner);
    header.mutable_params()->mutable_sampling()->set_target_points(20000);
    header.mutable_params()->set_directions("random:4000:" + std::to_string(seed));
    header.set_mesh_sha256(wire::sha256_hex(mesh_));
    header.set_mesh_bytes(mesh_.size());
    writer->Write(message);
    message.set_data(mesh_);
    writer->Write(message);
    writer->WritesDone();
    EXPECT_TRUE(writer->Finish().ok());
    return response.job().id();
  }

  /// Owners of the grants, in order, and "!" where bob's job came: the first line about it, for a worker that waits may
  /// be granted it before the server has written that it came.
  std::string grants(const std::string& bobs) const {
    std::string text;
    std::istringstream lines(lab_.read("server.log"));
    for (std::string line; std::getline(lines, line);) {
      const bool of_bob = line.find("job=" + bobs) != std::string::npos;
      if (of_bob && text.find('!') == std::string::npos) text += '!';
      if (line.find("event=leased") != std::string::npos) text += of_bob ? 'b' : 'a';
    }
    return text;
  }

  Lab lab_;
  std::string mesh_;
};

TEST_F(TurnsTest, ALongQueueOfOneOwnerDelaysAnotherByABlockPerWorker) {
  ASSERT_EQ(lab_.run({AFFSKEL_CLIENT_BINARY, "make", "torus", "--triangles", "512", "-o", lab_.path("m.off")})
                .exit_code,
            0);
  mesh_ = lab_.read("m.off");
  const Process server = lab_.server();
  std::vector<Process> workers;
  for (int i = 0; i < kTurnWorkers; ++i) workers.push_back(lab_.worker({"--threads", "1"}));
  std::string first;
  for (int i = 0; i < kAdasJobs; ++i) {
    const std::string id = submit_as("ada", i);
    if (i == 0) first = id;
  }
  lab_.follow(first, [](const v1::Job& job) { return job.directions_done() > 0; });
  const std::string bobs = submit_as("bob", kAdasJobs);
  ASSERT_EQ(lab_.follow_to_end(bobs).state(), v1::JOB_STATE_DONE);
  const std::string order = grants(bobs);
  const std::string after = order.substr(order.find('!') + 1);
  EXPECT_LE(after.find('b'), static_cast<std::size_t>(kTurnWorkers)) << after;
  // From then on each owner has a worker; what is prepared and derived has one alone.
  int adas = 0, bobs_grants = 0;
  for (const char grant : after.substr(0, after.rfind('b') + 1)) ++(grant == 'a' ? adas : bobs_grants);
  EXPECT_LE(adas, 2 * bobs_grants) << after;
  EXPECT_GT(adas, 0) << "and it does not stop the others";
}

}  // namespace
}  // namespace affskel::integration
