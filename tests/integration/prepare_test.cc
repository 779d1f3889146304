// Meshes that take minutes to be made ready: leaving and cancelling take effect meanwhile, and there is a bound.
#include <gtest/gtest.h>

#include <csignal>
#include <cstddef>
#include <sstream>

#include "lab.h"
#include "tools/crossing_boxes.h"
#include "wire/sha256.h"

namespace affskel::integration {
namespace {

class PrepareTest : public testing::Test {
 protected:
  /// Without the client's look at the mesh, which would take as long.
  std::string submit_crossing_boxes() {
    const std::string mesh = tests::crossing_boxes(20000);
    grpc::ClientContext context;
    v1::SubmitJobResponse response;
    const auto writer = lab_.stub().SubmitJob(&context, &response);
    v1::SubmitJobRequest message;
    v1::SubmitJobHeader& header = *message.mutable_header();
    header.mutable_params()->mutable_sampling()->set_target_points(1000);
    header.mutable_params()->set_repair(true);
    header.set_mesh_sha256(wire::sha256_hex(mesh));
    header.set_mesh_bytes(mesh.size());
    writer->Write(message);
    constexpr std::size_t kPart = 1 << 20;
    for (std::size_t at = 0; at < mesh.size(); at += kPart) {
      message.set_data(mesh.substr(at, kPart));
      writer->Write(message);
    }
    writer->WritesDone();
    EXPECT_TRUE(writer->Finish().ok());
    return response.job().id();
  }

  /// Until a worker has begun to make it ready.
  void follow_to_work(const std::string& id) {
    const v1::Job job = lab_.follow(id, [](const v1::Job& j) { return j.state() == v1::JOB_STATE_RUNNING; });
    ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << job.error().message();
    ASSERT_EQ(job.stage(), v1::JOB_STAGE_PREPARE);
  }

  /// 30,000 boxes one within the other.
  void make_nested_boxes() {
    constexpr int kBoxes = 30000;
    std::ostringstream text;
    text << "OFF\n" << 8 * kBoxes << ' ' << 6 * kBoxes << " 0\n";
    for (int i = 1; i <= kBoxes; ++i) {
      for (int corner = 0; corner < 8; ++corner)
        text << (corner & 1 ? i : -i) << ' ' << (corner & 2 ? i : -i) << ' ' << (corner & 4 ? i : -i) << '\n';
    }
    for (int i = 0; i < kBoxes; ++i) {
      for (const char* face : {"0231", "4576", "0154", "2673", "0462", "1375"}) {
        text << 4;
        for (const char* c = face; *c != 0; ++c) text << ' ' << 8 * i + (*c - '0');
        text << '\n';
      }
    }
    lab_.write("m.off", text.str());
  }

  Lab lab_;
};

TEST_F(PrepareTest, CancelIsHeardAndTheWorkerFreeForOthers) {
  const Process server = lab_.server();
  const Process worker = lab_.worker({"--threads", "2"});
  const std::string id = submit_crossing_boxes();
  follow_to_work(id);
  EXPECT_EQ(lab_.client({"cancel", id}).exit_code, 0);
  EXPECT_EQ(lab_.follow_to_end(id).state(), v1::JOB_STATE_CANCELLED);
  lab_.make_torus(256);
  const v1::Job next = lab_.follow_to_end(lab_.submit({"--points", "1000"}));
  EXPECT_EQ(next.state(), v1::JOB_STATE_DONE) << next.error().message();
}

TEST_F(PrepareTest, SigtermIsHeardAndTheTaskGivenBack) {
  const Process server = lab_.server();
  Process worker = lab_.worker({"--threads", "2"});
  const std::string id = submit_crossing_boxes();
  follow_to_work(id);
  worker.send(SIGTERM);
  EXPECT_EQ(worker.wait(), 0);
  const v1::Job job = lab_.job(id);
  EXPECT_EQ(job.counters().leases_lost(), 0U);
  EXPECT_NE(job.state(), v1::JOB_STATE_FAILED) << job.error().message();
}

TEST_F(PrepareTest, WhatTakesTooLongFailsForGood) {
  const Process server = lab_.server();
  const Process worker = lab_.worker({"--threads", "2", "--prepare-limit", "1"});
  const v1::Job job = lab_.follow_to_end(submit_crossing_boxes());
  ASSERT_EQ(job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.error().code(), "LIMIT");
  EXPECT_NE(job.error().message().find("1 s of processor time"), std::string::npos) << job.error().message();
}

TEST_F(PrepareTest, TakesManyNestedSurfaces) {
  make_nested_boxes();
  const Output inspected = lab_.client({"inspect", lab_.path("m.off")});
  EXPECT_EQ(inspected.exit_code, 0) << inspected.err;
  EXPECT_NE(inspected.out.find("cavities:             15000\n"), std::string::npos)
      << inspected.out.substr(0, 800);
  const Process server = lab_.server();
  // Far less than the square of their number took.
  const Process worker = lab_.worker({"--threads", "2", "--prepare-limit", "60"});
  const std::string id = lab_.submit({"--points", "1000", "--directions", "random:100:1"});
  const v1::Job job = lab_.follow(id, [](const v1::Job& j) { return j.stage() != v1::JOB_STAGE_PREPARE; });
  EXPECT_NE(job.state(), v1::JOB_STATE_FAILED) << job.error().message();
  EXPECT_EQ(lab_.client({"cancel", id}).exit_code, 0);
}

}  // namespace
}  // namespace affskel::integration
