// The messages of the contract, as a server and its workers check them before they believe them.
#include <google/protobuf/message.h>

#include "affskel/v1/client_service.pb.h"
#include "affskel/v1/worker_service.pb.h"
#include "bytes.h"
#include "database/errors.h"
#include "http/message.h"
#include "store/field.h"
#include "store/refined.h"
#include "store/submission.h"
#include "targets.h"
#include "wire/artifact_kinds.h"
#include "wire/params.h"

namespace affskel::fuzz {
namespace {

constexpr std::uint64_t kMaxMeshBytes = 1 << 30;

template <typename Message>
Message parsed(std::string_view bytes) {
  Message message;
  message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
  return message;
}

// What is canonical stays as it is, and has its own key.
template <typename Params>
void check_canonical(const Params& params) {
  try {
    const Params once = wire::canonical(params), twice = wire::canonical(once);
    if (once.SerializeAsString() != twice.SerializeAsString() ||
        wire::cache_key(once) != wire::cache_key(twice))
      throw Finding("canonical parameters are not canonical: " + once.ShortDebugString());
  } catch (const std::invalid_argument&) {
  }
}

void submit(std::string_view bytes) {
  const auto header = parsed<v1::SubmitJobHeader>(bytes);
  check_canonical(header.params());
  try {
    const server::Submission submission = server::checked_submission(header, kMaxMeshBytes);
    if (server::announced_bytes(submission.header) > 2 * kMaxMeshBytes)
      throw Finding("too much is announced");
    server::checked_meshes(submission, bytes);
  } catch (const server::StoreError&) {
  }
}

void fetch(std::string_view bytes) {
  const auto request = parsed<v1::FetchArtifactRequest>(bytes);
  check_canonical(request.skeleton());
  check_canonical(request.surface());
  check_canonical(request.eroded());
  try {
    wire::check_request(request);
  } catch (const std::invalid_argument&) {
  }
  for (const wire::ArtifactKindInfo& kind : wire::artifact_kinds()) {
    try {
      const wire::CanonicalParams params =
          wire::artifact_params(kind, request, wire::canonical(v1::SkeletonParams()));
      v1::Lease lease;
      if (kind.derived() && !wire::set_task_params(kind.params, params.bytes, lease))
        throw Finding("a worker cannot read what the server has stored");
    } catch (const std::invalid_argument&) {
    }
  }
}

void report(std::string_view bytes) {
  const auto request = parsed<v1::ReportErosionRequest>(bytes);
  try {
    server::RecordBatch batch(1000, 100, 1);
    batch.append(request.records());
    batch.sort();
    for (const wire::PointRecord& record : batch.records())
      if (record.point >= 1000) throw Finding("a record of a point that is not there was taken");
  } catch (const server::StoreError&) {
  }
  try {
    server::RefinedBatch batch({1000, 1, 50});
    batch.append(request.refined());
  } catch (const server::StoreError&) {
  }
}

void lease(std::string_view bytes) {
  for (const wire::ArtifactKindInfo& kind : wire::artifact_kinds()) {
    v1::Lease lease;
    wire::set_task_params(kind.params, std::string(bytes), lease);
  }
}

void run(std::string_view input) {
  Bytes bytes(input);
  const unsigned which = bytes.below(6);
  const std::string_view rest = bytes.rest();
  if (which == 0) submit(rest);
  if (which == 1) fetch(rest);
  if (which == 2) report(rest);
  if (which == 3) lease(rest);
  if (which == 4) http::parse_target(rest);
  if (which == 5) {
    try {
      const std::string once = wire::canonical_directions(rest);
      if (wire::canonical_directions(once) != once) throw Finding("directions are not canonical: " + once);
    } catch (const std::invalid_argument&) {
    }
  }
}

std::vector<std::string> seeds() {
  v1::SubmitJobHeader header;
  header.set_name("body");
  header.mutable_params()->mutable_sampling()->set_spacing(0.5);
  header.mutable_params()->set_directions("triangles+sphere:100+random:9:1");
  header.mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  header.set_mesh_sha256(std::string(64, 'a'));
  header.set_mesh_bytes(5);
  header.mutable_repair()->set_source_sha256(std::string(64, 'b'));
  header.mutable_repair()->set_source_bytes(7);
  header.mutable_repair()->add_steps()->set_code("flaps");
  v1::FetchArtifactRequest request;
  request.set_job("@last");
  request.set_kind(v1::ARTIFACT_KIND_SURFACE);
  request.mutable_surface()->set_min_barrier(0.1);
  request.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  request.mutable_eroded()->set_fraction(0.2);
  v1::ReportErosionRequest report;
  report.mutable_records()->add_point(3);
  report.mutable_records()->add_direction(4);
  report.mutable_records()->add_erosion(0.5);
  report.mutable_records()->add_area(2);
  v1::ReportErosionRequest refined;
  refined.mutable_refined()->add_point(3);
  refined.mutable_refined()->add_erosion(0.5);
  refined.mutable_refined()->add_slope(2);
  for (const double c : {0.0, 0.6, 0.8}) refined.mutable_refined()->add_normal(c);
  for (int s = 0; s < 2; ++s) refined.mutable_refined()->add_saddle(7);
  return {'\0' + header.SerializeAsString(),
          '\1' + request.SerializeAsString(),
          '\2' + report.SerializeAsString(),
          '\2' + refined.SerializeAsString(),
          '\3' + request.surface().SerializeAsString(),
          "\4/api/jobs?limit=5&state=done%20",
          "\5triangles+sphere:1000+random:60:7"};
}

}  // namespace

const Target kMessages = {"messages", seeds, run, 20000};

}  // namespace affskel::fuzz
