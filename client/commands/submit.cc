#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/utf8.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/transfer.h"
#include "client/files/read/input_file.h"
#include "client/text/message_json.h"
#include "client/text/words.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

struct SubmitOptions {
  std::string file;
  bool wait = false;
  std::string output_dir;  // empty = fetch nothing; otherwise implies wait
  double spacing = 0;      // mesh units; 0 = by points
  std::uint64_t points = 100000;
  std::string directions = "triangles";
  std::string frame = "axis";
  SkeletonOptions skeleton{"zucker-hummel"};
  std::string name;  // empty = the file's stem
  unsigned priority = 5;
  std::string request_id;
  std::string repair = "auto";
};

namespace fs = std::filesystem;

constexpr std::size_t kMaxName = 200, kMaxOwner = 100, kMaxRequestId = 200;  // bytes, by the protocol

// As the protocol takes it.
std::string protocol_text(const std::string& text, std::size_t max_bytes) {
  return std::string(base::truncate_utf8(base::to_utf8(text), max_bytes));
}

void require_short(const std::string& text, std::size_t bytes, const std::string& option) {
  if (text.size() > bytes) {
    throw ClientError(ExitCode::kUsage, option + " has " + std::to_string(text.size()) + " bytes; at most " +
                                            std::to_string(bytes) + " are possible");
  }
}

v1::SubmitJobHeader header_for(const SubmitOptions& options, const InputFile& input) {
  require_short(options.name, kMaxName, "--name");
  require_short(options.request_id, kMaxRequestId, "--request-id");
  v1::SubmitJobHeader header;
  header.set_name(options.name.empty() ? protocol_text(fs::path(input.path).stem().string(), kMaxName)
                                       : options.name);
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

void check_size(const v1::ServerInfo& server, const InputFile& input) {
  const std::uint64_t most = server.max_mesh_bytes();
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

void run(Context& context, const SubmitOptions& options) {
  Console& console = context.console();
  const InputFile input = read_input(options.file);
  tell_conversion(input, console);
  check_mesh(input, options, console);
  v1::SubmitJobHeader header = header_for(options, input);
  prepare_output_dir(options.output_dir);
  const v1::ServerInfo server = context.session().server_info();
  check_size(server, input);
  // A server that does not know who calls is told.
  if (server.caller().owner().empty())
    header.set_owner(protocol_text(user_name(context.environment()), kMaxOwner));
  bool existed = false;
  v1::Job job = context.session().submit(header, input.bytes, existed);
  console.result(job.id() + "\n");
  if (existed)
    console.note("the same was submitted before: this is that job, " + std::string("name ") + job.name());
  const bool wait = options.wait || !options.output_dir.empty();
  if (wait) job = follow(context, job.id(), false);
  std::vector<Written> written;
  if (wait && job.state() == v1::JOB_STATE_DONE) {
    warn_about_skeleton(console, job.skeleton_points(), job.quality(), job);
    if (!options.output_dir.empty()) written = fetch_results(context, job, options);
  }
  nlohmann::ordered_json document = to_json(job);
  document["existed"] = existed;
  for (const Written& file : written) document["files"][file.kind] = file.destination.file.string();
  console.document(document);
  if (wait) throw_unless_done(job);
}

void add_following_options(CLI::App* command, SubmitOptions& o) {
  command->add_flag("-w,--wait", o.wait, "Follow the job to its end");
  command
      ->add_option("-o,--output-dir", o.output_dir,
                   "Wait, then write STEM.field.vtkhdf, STEM.skeleton.ply and STEM.surface.off here")
      ->type_name("DIR");
}

void add_field_options(CLI::App* command, SubmitOptions& o) {
  CLI::Option* spacing = command->add_option("--spacing", o.spacing, "Lattice spacing in mesh units")
                             ->check(positive_number())
                             ->type_name("DT");
  command->add_option("--points", o.points, "Aim at this many sample points")
      ->check(whole_number(1, std::uint64_t{1} << 31))
      ->capture_default_str()
      ->type_name("R")
      ->excludes(spacing);
  command->add_option("--directions", o.directions, "triangles, sphere:N, random:N:SEED, joined by +")
      ->check(direction_set())
      ->capture_default_str()
      ->type_name("SET");
  command
      ->add_option("--frame", o.frame,
                   "Axes of the lattice: the mesh's, the principal ones, the least box's, or those that make "
                   "the result affinely invariant")
      ->check(CLI::IsMember(frame_words()))
      ->capture_default_str()
      ->type_name("FRAME");
}

void add_queue_options(CLI::App* command, SubmitOptions& o) {
  command->add_option("--name", o.name, "Name for people (default: the file's)")
      ->check(utf8_text())
      ->type_name("NAME");
  command->add_option("--priority", o.priority, "0 .. 9, higher first")
      ->check(whole_number(0, 9))
      ->capture_default_str()
      ->type_name("P");
  command
      ->add_option("--request-id", o.request_id,
                   "Submitting again with the same key and content gives the same job")
      ->check(utf8_text())
      ->type_name("KEY");
  command->add_option("--repair", o.repair, "Weld, turn and drop what needs it, and say so, or refuse")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str()
      ->type_name("MODE");
}

}  // namespace

void add_submit(CommandLine& line) {
  const auto options = std::make_shared<SubmitOptions>();
  SubmitOptions& o = *options;
  CLI::App* command =
      line.add("submit", "Check a mesh and submit it; prints the job id",
               "  affskel-client submit body.off --spacing 200 -o OUT\n"
               "  affskel-client submit cube.off --points 50000 --directions triangles+sphere:1000 --wait\n"
               "  JOB=$(affskel-client submit body.off --name subject-7)",
               [options](Context& context) { run(context, *options); });
  command
      ->add_option(
          "FILE", o.file,
          "Closed triangle mesh: Geomview OFF text, or .ply .obj .stl .vtp, which are submitted as OFF text")
      ->required()
      ->type_name("");
  add_following_options(command, o);
  add_field_options(command, o);
  add_skeleton_options(command, o.skeleton);
  add_queue_options(command, o);
}

}  // namespace affskel::client
