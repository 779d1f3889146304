#include "client/operations/submission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/number_text.h"
#include "base/utf8.h"
#include "client/text/printable.h"
#include "client/text/summary_text.h"
#include "client/text/words.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"
#include "wire/sha256.h"

namespace affskel::client {
double longest_side(const core::Solid& solid) {
  const core::Vec3 size = solid.bbox_max - solid.bbox_min;
  return std::max({size.x, size.y, size.z});
}

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxName = 200, kMaxOwner = 100, kMaxRequestId = 200;  // bytes, by the protocol
constexpr std::size_t kMaxStepMessage = 1000;
constexpr double kLeastPoints = 8;  // in the volume: a skeleton of fewer tells nothing

// As the protocol takes it.
std::string protocol_text(const std::string& text, std::size_t max_bytes) {
  return std::string(base::truncate_utf8(base::to_utf8(text), max_bytes));
}

void require_short(const std::string& text, std::size_t bytes, const std::string& what) {
  if (text.size() > bytes) {
    throw ClientError(ExitCode::kUsage, "the " + what + " has " + std::to_string(text.size()) +
                                            " bytes; at most " + std::to_string(bytes) + " are possible");
  }
}

v1::SubmitJobHeader header_for(const Submission& submission, const InputFile& input, std::string_view text) {
  require_short(submission.name, kMaxName, "name");
  require_short(submission.request_id, kMaxRequestId, "request id");
  v1::SubmitJobHeader header;
  header.set_name(submission.name.empty() ? protocol_text(one_line(job_name(input.path)), kMaxName)
                                          : submission.name);
  header.set_priority(submission.priority);
  v1::Sampling& sampling = *header.mutable_params()->mutable_sampling();
  if (submission.spacing > 0) {
    sampling.set_spacing(submission.spacing);
  } else {
    sampling.set_target_points(submission.points);
  }
  header.mutable_params()->set_directions(submission.directions);
  header.mutable_params()->set_frame(frame_named(submission.frame));
  header.mutable_params()->set_minimum(minimum_named(submission.minimum));
  header.mutable_params()->set_repair(submission.repair);
  *header.mutable_skeleton() = skeleton_params(submission.skeleton);
  header.set_request_id(submission.request_id);
  header.set_mesh_sha256(wire::sha256_hex(text));
  header.set_mesh_bytes(text.size());
  return header;
}

v1::MeshRepair repair_of(const MeshSource& source) {
  v1::MeshRepair repair;
  repair.set_source_sha256(wire::sha256_hex(source.bytes));
  repair.set_source_bytes(source.bytes.size());
  for (const core::RepairStep& step : source.steps) {
    v1::RepairStep& told = *repair.add_steps();
    told.set_code(step.code);
    told.set_count(step.count);
    told.set_message(protocol_text(step.message, kMaxStepMessage));
    told.set_severity(core::severity_word(step.severity));
  }
  return repair;
}

void check_size(const v1::ServerInfo& server, const std::string& path, std::string_view bytes) {
  const std::uint64_t most = server.max_mesh_bytes();
  if (most > 0 && bytes.size() > most) {
    throw ClientError(
        ExitCode::kLimit,
        "has " + std::to_string(bytes.size()) + " bytes; the server takes at most " + std::to_string(most),
        path);
  }
}

// "1.3 x 0.37 x 1.8 units, the size of a person in metres".
std::string size_text(const core::Vec3& size, double longest) {
  std::string text = base::rounded(size.x, 3) + " x " + base::rounded(size.y, 3) + " x " +
                     base::rounded(size.z, 3) + " units";
  constexpr std::array<std::pair<double, const char*>, 3> kUnits = {
      {{1, "metres"}, {100, "centimetres"}, {1000, "millimetres"}}};
  for (const auto& [unit, name] : kUnits)
    if (longest >= 0.5 * unit && longest <= 2.5 * unit)
      text += std::string(", the size of a person in ") + name;
  return text;
}

}  // namespace

void check_spacing(const core::Solid& solid, double spacing, const std::string& path) {
  const core::Vec3 size = solid.bbox_max - solid.bbox_min;
  const double longest = longest_side(solid);
  if (spacing <= 0.5 * longest && solid.volume >= kLeastPoints * spacing * spacing * spacing) return;
  const double good = std::cbrt(solid.volume / 1e5);
  throw ClientError(ExitCode::kBadInput,
                    "the spacing " + base::to_text(spacing) +
                        " leaves no room for sample points: the mesh measures " + size_text(size, longest) +
                        "; a spacing of " + base::rounded(good, 2) + " gives 100000 points",
                    path);
}

void check_submission(const core::Solid& solid, const InputFile& input, const Submission& submission) {
  check_spacing(solid, submission.spacing, input.path);
  try {
    core::LatticeOptions lattice;
    lattice.spacing = submission.spacing;
    lattice.target_points = submission.points;
    core::check_lattice(solid, core::parse_frame(submission.frame), lattice);
    core::check_directions(solid, submission.directions);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, input.path);
  }
}

Notices direction_notices(const core::Solid& solid, const Submission& asked) {
  constexpr std::size_t kMany = 30000;
  const std::size_t count = solid.mesh.triangles.size();
  if (asked.directions != "triangles" || asked.minimum == "infimum" || count < kMany) return {};
  Notice many = note("MANY_DIRECTIONS",
                     std::to_string(count) +
                         " triangles are a direction each, which takes long; 5000 evenly from all sides give "
                         "nearly the same");
  v1::Setting& directions = many.to_try.emplace_back();
  directions.set_name("directions");
  directions.set_value("sphere:5000");
  return {std::move(many)};
}

Submitted submit(Session& session, const Environment& environment, const InputFile& input,
                 const MeshSource* source, const Submission& submission) {
  const OffText text(input);
  v1::SubmitJobHeader header = header_for(submission, input, text.view());
  GivenMeshes meshes{text.view(), {}};
  const v1::ServerInfo server = session.server_info();
  check_size(server, input.path, text.view());
  if (source != nullptr) {
    check_size(server, input.path, source->bytes);
    *header.mutable_repair() = repair_of(*source);
    meshes.source = source->bytes;
  }
  if (server.caller().owner().empty()) header.set_owner(protocol_text(user_name(environment), kMaxOwner));
  Submitted submitted;
  submitted.job = session.submit(header, meshes, submitted.existed);
  return submitted;
}

Notices reuse_notices(const Submitted& submitted) {
  if (submitted.existed) {
    return {note("EXISTED", "the same was submitted before: this is that job, name " + submitted.job.name())};
  }
  if (!took_field_over(submitted.job)) return {};
  return {
      note("FIELD_TAKEN_OVER", "this mesh was eroded with these parameters before: the field is taken over")};
}

}  // namespace affskel::client
