#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/cli/number_parsers.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/repair_option.h"
#include "client/commands/shared/shape_options.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/written.h"
#include "client/operations/submission.h"
#include "client/text/message_json.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

struct SubmitOptions {
  std::string file;
  bool wait = false;
  std::string output_dir;  // empty = fetch nothing; otherwise implies wait
  Submission asked;
  std::string spacing;  // mesh units, or a share of the mesh's length in %
  std::string repair = "auto";
  core::MeshFileOptions reading;
};

namespace fs = std::filesystem;

// Where results will be written.  Those folders of it that were missing go again unless it is kept: an empty one
// tells of results where nothing was submitted.
class OutputFolder {
 public:
  // Before hours of computing, not after: the names that will be written may be too long, or those of files that must
  // not be replaced.
  OutputFolder(const fs::path& directory, const fs::path& name) {
    std::error_code error;
    for (fs::path missing = directory; !missing.empty() && !fs::exists(missing, error);
         missing = missing.parent_path())
      made_.push_back(missing);
    fs::create_directories(directory, error);
    if (error) throw error_from_errno(error.value(), "cannot create the directory", directory.string());
    try {
      for (const FetchRequest& request : main_files(v1::Job(), (directory / name).string()))
        const base::AtomicFile trial(request.destination.file);  // never appears
    } catch (...) {
      remove();
      throw;
    }
  }
  ~OutputFolder() { remove(); }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  void keep() { made_.clear(); }

 private:
  // Where somebody has put something by now, it stays.
  void remove() {
    std::error_code error;
    for (const fs::path& folder : made_) fs::remove(folder, error);
    made_.clear();
  }

  std::vector<fs::path> made_;  // innermost first
};

std::vector<Fetched> fetch_results(Context& context, const v1::Job& job, const fs::path& directory,
                                   const fs::path& name) {
  std::vector<Fetched> files;
  for (const FetchRequest& request : main_files(job, (directory / name).string())) {
    files.push_back(fetch(context.session(), request));
    show_written(context.console(), files.back());
  }
  return files;
}

// The field's path, and those of the skeleton in an array.
nlohmann::ordered_json paths_of(const std::vector<Fetched>& files) {
  nlohmann::ordered_json paths;
  for (const Fetched& file : files) {
    const std::string path = file.destination.file.string();
    if (file.artifact == "field") {
      paths["field"] = path;
    } else {
      paths[file.artifact].push_back(path);
    }
  }
  return paths;
}

// "180", or "1%" of the longest side of the solid's box.
double spacing_of(const std::string& text, const core::Solid& solid) {
  if (text.empty()) return 0;
  return text.ends_with('%') ? *parse_share(text) * longest_side(solid) : std::stod(text);
}

// What a worker would refuse, before anything is sent.  Returns what was said of the mesh.
// @param submission gets the spacing.
Notices check_mesh(const InputFile& input, const core::Solid& solid, const std::string& spacing,
                   Submission& submission, Console& console) {
  submission.spacing = spacing_of(spacing, solid);
  if (spacing.ends_with('%')) console.note("spacing " + base::to_text(submission.spacing));
  check_submission(solid, input, submission);
  Notices notices = solid_notices(solid, input);
  say(console, notices);
  return notices;
}

struct SubmittedSolid {
  core::Solid solid;
  std::optional<MeshSource> source;  // of which its mesh came by a repair
  Notices said;                      // what is wrong with that
};

// What is mended beyond what workers mend is another mesh.
void replace(Context& context, const std::string& file, const RepairChoice& choice, InputFile& input,
             SubmittedSolid& found) {
  Repair done = repaired(context, input.off.mesh, file, choice);
  if (done.steps.empty()) return;
  for (const core::RepairStep& step : done.steps)
    if (!is_warning(step))
      say(context.console(), note(step.code, "repaired before it was sent: " + step.message, input.path));
  found.said = repair_warnings(done.steps, input.path);
  say(context.console(), found.said);
  found.source = replace_mesh(input, std::move(done));
}

// Unasked, only a mesh that bounds no solid is replaced: what workers mend is sent as it is.
SubmittedSolid solid_of(Context& context, const std::string& file, const RepairChoice& repair,
                        InputFile& input) {
  using Kind = RepairChoice::Kind;
  SubmittedSolid found;
  if (repair.kind == Kind::kFill || repair.kind == Kind::kWrap) replace(context, file, repair, input, found);
  try {
    found.solid = check_solid(input, repair.kind != Kind::kNone);
    return found;
  } catch (const ClientError& error) {
    if (repair.kind != Kind::kAuto || error.exit_code() != ExitCode::kBadInput) throw;
  }
  replace(context, file, repair, input, found);
  found.solid = check_solid(input, true);
  return found;
}

// What keeps the id from being printed does not keep the job from being computed.
template <typename Print>
void print_of(const v1::Job& job, Print&& print) {
  try {
    print();
  } catch (const ClientError& error) {
    throw ClientError(error.exit_code(), std::string(error.what()) + "; job " + job.id() + " was submitted",
                      error.file());
  }
}

void run_submit(Context& context, const SubmitOptions& options) {
  Console& console = context.console();
  const RepairChoice repair = chosen_repair(options.repair);
  InputFile input = context.within_budget(Budget::Work::kReading, options.file,
                                          [&] { return read_named_input(options.file, options.reading); });
  say(console, conversion_notices(input));
  SubmittedSolid found = context.within_budget(
      Budget::Work::kRepair, options.file, [&] { return solid_of(context, options.file, repair, input); });
  Submission asked = options.asked;
  asked.repair = repair.kind != RepairChoice::Kind::kNone;
  append(found.said, check_mesh(input, found.solid, options.spacing, asked, console));
  say(console, direction_notices(found.solid, asked));
  std::optional<OutputFolder> output;
  if (!options.output_dir.empty()) output.emplace(options.output_dir, job_name(input.path));
  const Submitted submitted =
      submit(context.session(), context.environment(), input, found.source ? &*found.source : nullptr, asked);
  if (output) output->keep();
  v1::Job job = submitted.job;
  print_of(job, [&] { console.result(job.id() + "\n"); });
  say(console, reuse_notices(submitted));
  const bool wait = options.wait || !options.output_dir.empty();
  if (wait) job = follow(context, job.id(), false, !options.output_dir.empty());
  nlohmann::ordered_json document = to_json(job);
  document["existed"] = submitted.existed;
  if (found.source) document["repaired"] = steps_json(found.source->steps);
  if (job.state() == v1::JOB_STATE_DONE && !options.output_dir.empty()) {
    document["files"] = paths_of(fetch_results(context, job, options.output_dir, job_name(input.path)));
  }
  print_of(job, [&] { console.document(document); });
  if (wait) show_end(context, job, found.said);
}

void add_following_options(CLI::App* command, SubmitOptions& o) {
  command->add_flag("-w,--wait", o.wait, "Follow the job to its end");
  command
      ->add_option("-o,--output-dir", o.output_dir,
                   "Wait, then write STEM.field.vti (.vts where the lattice is turned),\nSTEM.skeleton.vtp "
                   "and STEM.skeleton.ply here")
      ->check(non_empty())
      ->type_name("DIR");
}

void add_field_options(CLI::App* command, SubmitOptions& o) {
  CLI::Option* points = command->add_option("--points", o.asked.points, "Aim at this many sample points")
                            ->check(whole_number(1, kMaxPoints))
                            ->capture_default_str()
                            ->type_name("R");
  command
      ->add_option("--spacing", o.spacing,
                   "Lattice spacing instead: in mesh units, or as a share of the mesh's length: 1%")
      ->check(positive_number_or_share())
      ->type_name("DT")
      ->excludes(points);
  command->add_option("--directions", o.asked.directions, "triangles, sphere:N, random:N:SEED, joined by +")
      ->check(direction_set())
      ->capture_default_str()
      ->type_name("SET");
  command
      ->add_option("--frame", o.asked.frame,
                   "Axes of the lattice: the mesh's, the principal ones, the least box's, or those that make "
                   "the result affinely invariant")
      ->check(one_of(frame_words()))
      ->capture_default_str()
      ->type_name("FRAME");
  command
      ->add_option("--minimum", o.asked.minimum,
                   "E over the directions (set), or over all, beginning from these (infimum):\nof the solid "
                   "alone, however it is tessellated; takes longer")
      ->check(one_of(minimum_words()))
      ->capture_default_str()
      ->type_name("MINIMUM");
}

void add_queue_options(CLI::App* command, SubmitOptions& o) {
  command->add_option("--name", o.asked.name, "Name for people (default: the file's)")
      ->check(utf8_text())
      ->type_name("NAME");
  command->add_option("--priority", o.asked.priority, "0 .. 9, higher first")
      ->check(whole_number(0, kMaxPriority))
      ->capture_default_str()
      ->type_name("P");
  command
      ->add_option("--request-id", o.asked.request_id,
                   "Submitting again with the same key and content gives the same job")
      ->check(utf8_text())
      ->type_name("KEY");
  add_isovalue(command, o.reading.isovalue);
  add_repair_option(
      command, o.repair,
      "auto submits a mesh that bounds a solid as it is, of others what repair makes of them;\nnone refuses these; fill=LENGTH, wrap and wrap=ALPHA submit what repair makes by them");
}

}  // namespace

void add_submit(CommandLine& line) {
  const auto options = std::make_shared<SubmitOptions>();
  SubmitOptions& o = *options;
  CLI::App* command =
      line.add("submit", "Check a mesh and submit it; prints the job id",
               "  affskel-client submit body.off -o OUT\n"
               "  affskel-client submit body.off --spacing 200 --wait       # in the mesh's units; or 1%\n"
               "  affskel-client submit body.off --minimum infimum --wait   # over all directions\n"
               "  affskel-client submit cube.off --points 50000 --directions triangles+sphere:1000 --wait\n"
               "  JOB=$(affskel-client submit body.off --name subject-7)\n"
               "  affskel-client make torus -o - | affskel-client submit - --wait",
               [options](Context& context) { run_submit(context, *options); });
  command
      ->add_option(
          "FILE", o.file,
          "Closed triangle mesh: " + mesh_kinds() +
              ";\nwith --repair wrap points, too (.xyz, .csv, .ply). Submitted as OFF text. - reads it from\n"
              "stdin")
      ->required()
      ->check(mesh_file())
      ->type_name("");
  add_following_options(command, o);
  add_field_options(command, o);
  add_skeleton_options(command, o.asked.skeleton);
  add_queue_options(command, o);
}

}  // namespace affskel::client
