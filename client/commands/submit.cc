#include <filesystem>
#include <nlohmann/json.hpp>

#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/transfer.h"
#include "client/files/read/input_file.h"
#include "client/text/message_json.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"
#include "wire/sha256.h"
#include "wire/utf8.h"

namespace affskel::client {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxName = 200, kMaxOwner = 100, kMaxRequestId = 200;  // bytes, by the protocol

// As the protocol takes it.
std::string protocol_text(const std::string& text, std::size_t max_bytes) {
  return std::string(wire::truncate_utf8(wire::to_utf8(text), max_bytes));
}

void require_short(const std::string& text, std::size_t bytes, const std::string& option) {
  if (text.size() > bytes) {
    throw ClientError(ExitCode::kUsage, option + " has " + std::to_string(text.size()) + " bytes; at most " +
                                            std::to_string(bytes) + " are possible");
  }
}

v1::Frame frame_named(const std::string& name) {
  if (name == "pca") return v1::FRAME_PCA;
  if (name == "obb") return v1::FRAME_OBB;
  if (name == "affine") return v1::FRAME_AFFINE;
  return v1::FRAME_AXIS;
}

v1::SubmitJobHeader header_for(const SubmitOptions& options, const InputFile& input,
                               const std::string& owner) {
  require_short(options.name, kMaxName, "--name");
  require_short(options.request_id, kMaxRequestId, "--request-id");
  v1::SubmitJobHeader header;
  header.set_name(options.name.empty() ? protocol_text(fs::path(input.path).stem().string(), kMaxName)
                                       : options.name);
  header.set_owner(protocol_text(owner, kMaxOwner));
  header.set_priority(options.priority);
  v1::Sampling& sampling = *header.mutable_params()->mutable_sampling();
  if (options.spacing > 0) {
    sampling.set_spacing(options.spacing);
  } else {
    sampling.set_target_points(options.points);
  }
  header.mutable_params()->set_directions(options.directions);
  header.mutable_params()->set_frame(frame_named(options.frame));
  header.mutable_params()->set_repair(options.repair == "auto");
  *header.mutable_skeleton() = skeleton_params(options.skeleton);
  header.set_request_id(options.request_id);
  header.set_mesh_sha256(wire::sha256_hex(input.bytes));
  header.set_mesh_bytes(input.bytes.size());
  return header;
}

// Before hours of computing, not after.
void prepare_output_dir(const std::string& directory) {
  if (directory.empty()) return;
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw error_from_errno(error.value(), "cannot create the directory", directory);
}

std::vector<Written> fetch_results(Context& context, const v1::Job& job, const SubmitOptions& options) {
  const fs::path stem = fs::path(options.output_dir) / fs::path(options.file).stem();
  std::vector<Written> written;
  written.push_back(transfer_field(context, job.id(), {stem.string() + ".field.vtkhdf"}));
  tell_written(context.console(), written.back());
  written.push_back(transfer_skeleton(context, job.id(), nullptr, {stem.string() + ".skeleton.ply"}));
  tell_written(context.console(), written.back());
  written.push_back(transfer_surface(context, job.id(), nullptr, {stem.string() + ".surface.off"}));
  tell_written(context.console(), written.back());
  return written;
}

void check_size(Context& context, const InputFile& input) {
  const std::uint64_t most = context.session().server_info().max_mesh_bytes();
  if (most > 0 && input.bytes.size() > most) {
    throw ClientError(ExitCode::kLimit,
                      "has " + std::to_string(input.bytes.size()) + " bytes; the server takes at most " +
                          std::to_string(most),
                      input.path);
  }
}

// What a worker would refuse, before anything is sent.
void check_mesh(const InputFile& input, const SubmitOptions& options, Console& console) {
  const core::Solid solid = check_solid(input, options.repair == "auto");
  tell_notes(solid, input, console);
  try {
    core::LatticeOptions lattice;
    lattice.spacing = options.spacing;
    lattice.target_points = options.points;
    core::check_lattice(solid, core::parse_frame(options.frame), lattice);
    core::check_directions(solid, options.directions);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, input.path);
  }
}

}  // namespace

void run_submit(Context& context, const SubmitOptions& options) {
  Console& console = context.console();
  const InputFile input = read_input(options.file);
  tell_conversion(input, console);
  check_mesh(input, options, console);
  const v1::SubmitJobHeader header = header_for(options, input, user_name(context.environment()));
  prepare_output_dir(options.output_dir);
  check_size(context, input);
  bool existed = false;
  v1::Job job = context.session().submit(header, input.bytes, existed);
  console.result(job.id() + "\n");
  if (existed)
    console.note("the same was submitted before: this is that job, " + std::string("name ") + job.name());
  const bool wait = options.wait || !options.output_dir.empty();
  if (wait) job = follow(context, job.id(), false);
  std::vector<Written> written;
  if (wait && job.state() == v1::JOB_STATE_DONE) {
    warn_if_empty(console, job.skeleton_points(), job.quality(), job);
    if (!options.output_dir.empty()) written = fetch_results(context, job, options);
  }
  nlohmann::ordered_json document = to_json(job);
  document["existed"] = existed;
  for (const Written& file : written) document["files"][file.kind] = file.destination.file.string();
  console.document(document);
  if (wait) throw_unless_done(job);
}

}  // namespace affskel::client
