#include "client_fixture.h"

#include <sstream>

#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "sample_data.h"
#include "test_environment.h"
#include "tools/files.h"

namespace affskel::client {

v1::Job sample_job(v1::JobState state) {
  v1::Job job;
  job.set_id("0123456789abcdef0123456789abcdef");
  job.set_name("cube");
  job.set_owner("me");
  job.set_state(state);
  job.set_stage(state == v1::JOB_STATE_DONE ? v1::JOB_STAGE_COMPLETE : v1::JOB_STAGE_ERODE);
  job.set_directions_done(state == v1::JOB_STATE_DONE ? 12 : 5);
  job.set_directions_total(12);
  job.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  job.mutable_prepared()->set_points(5);
  job.mutable_prepared()->set_directions(2);
  job.mutable_prepared()->set_volume(8e9);
  job.mutable_prepared()->set_spacing(200);
  job.mutable_counters()->set_reports(3);
  job.set_skeleton_points(state == v1::JOB_STATE_DONE ? 2 : 0);
  job.set_mesh_bytes(std::uint64_t{1} << 53);
  return job;
}

ClientTest::ClientTest() : server_(service_) {
  service_.job = sample_job(v1::JOB_STATE_DONE);
  service_.watch = {sample_job(v1::JOB_STATE_QUEUED), sample_job(v1::JOB_STATE_RUNNING), service_.job};
  service_.artifacts[v1::ARTIFACT_KIND_LATTICE] = sample_lattice().SerializeAsString();
  service_.artifacts[v1::ARTIFACT_KIND_DIRECTIONS] = sample_directions().SerializeAsString();
  service_.artifacts[v1::ARTIFACT_KIND_FIELD] = sample_field();
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = sample_skeleton().SerializeAsString();
  v1::TriangleMesh surface = sample_sheet();
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = surface.SerializeAsString();
  surface.set_volume(8e8);
  for (const double v : {7., 8., 9.}) surface.add_area(v);
  service_.artifacts[v1::ARTIFACT_KIND_ERODED_SURFACE] = surface.SerializeAsString();
  v1::SkeletonPoints eroded = sample_skeleton();
  eroded.clear_divergence();
  service_.artifacts[v1::ARTIFACT_KIND_ERODED_POINTS] = eroded.SerializeAsString();
  service_.artifacts[v1::ARTIFACT_KIND_DIVERGENCE] = sample_divergence();
  service_.artifacts[v1::ARTIFACT_KIND_PARTS] = sample_parts().SerializeAsString();
  mesh_ = core::write_off(core::make_box(2000, 2000, 2000));
  service_.artifacts[v1::ARTIFACT_KIND_MESH] = mesh_;
  service_.artifacts[v1::ARTIFACT_KIND_SOURCE] = mesh_;
  tests::write_file(dir_ / "cube.off", mesh_);
  tests::write_file(dir_ / "bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1\n3 0 1 2\n");
  tests::write_file(dir_ / "open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
}

Outcome run_client_in(const tests::TemporaryDirectory& home, const std::vector<std::string>& arguments) {
  std::ostringstream out, err;
  RetryPolicy retry;
  retry.first_pause = std::chrono::milliseconds(1);
  retry.patience = std::chrono::milliseconds(200);
  Outcome outcome;
  outcome.exit_code =
      run_client(arguments, {out, err, false, test_environment({{"HOME", home.path()}}), retry});
  outcome.out = out.str();
  outcome.err = err.str();
  return outcome;
}

Outcome ClientTest::run(std::vector<std::string> arguments, const std::string& address) {
  arguments.insert(arguments.begin(), {"--server", address.empty() ? server_.address() : address});
  return run_client_in(dir_, arguments);
}

}  // namespace affskel::client
