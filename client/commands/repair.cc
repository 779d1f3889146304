#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/repair_option.h"
#include "client/commands/shared/shape_options.h"
#include "client/files/read/input_file.h"
#include "client/files/write/shape_writer.h"
#include "client/text/key_line.h"

namespace affskel::client {
namespace {

struct RepairOptions {
  std::string file, output, format, how = "auto";
  core::MeshFileOptions reading;
};

std::string steps_text(const Repair& done, bool is_sound) {
  std::string text;
  for (const core::RepairStep& step : done.steps)
    if (!is_warning(step)) text += key_line(step.code, step.message);
  if (done.steps.empty() && is_sound) text += key_line("sound", "yes");
  text += key_line("triangles", std::to_string(done.mesh.triangles.size()));
  return text + key_line("volume", base::plain(done.volume, base::kMeasureDigits));
}

void run_repair(Context& context, const RepairOptions& options) {
  Console& console = context.console();
  const RepairChoice choice = chosen_repair(options.how);
  const Destination destination = destination_of(options.output, options.format, console);
  const core::Mesh mesh = context.within_budget(Budget::Work::kReading, options.file, [&] {
    return read_named_input(options.file, options.reading).off.mesh;
  });
  const Repair done = context.within_budget(Budget::Work::kRepair, options.file,
                                            [&] { return repaired(context, mesh, options.file, choice); });
  Notices warnings = repair_warnings(done.steps, options.file);
  append(warnings, context.within_budget(Budget::Work::kRepair, options.file,
                                         [&] { return solid_warnings(done.mesh, options.file); }));
  ShapeFile shape;
  shape.off.mesh = done.mesh;
  const FileFormat format = choose_format(destination, shape_formats(shape), "mesh");
  base::AtomicFile file(destination.file);
  write_into(file, [&](const WriteBytes& write) { write_shape(format, shape, {"repaired"}, write); });
  file.commit();

  const std::string text = steps_text(done, warnings.empty());
  if (destination.is_stdout()) {
    console.note(text.substr(0, text.size() - 1));
  } else {
    console.result(text);
    console.note("wrote " + destination.name());
  }
  say(console, warnings);
  nlohmann::ordered_json warned = nlohmann::ordered_json::array();
  for (const Notice& notice : warnings)
    warned.push_back({{"code", notice.code}, {"message", notice.message}});
  console.document({{"file", options.output},
                    {"repair", options.how},
                    {"steps", steps_json(done.steps)},
                    {"warnings", std::move(warned)},
                    {"filled_share", done.filled_share},
                    {"points", done.mesh.points.size()},
                    {"triangles", done.mesh.triangles.size()},
                    {"volume", done.volume}});
}

}  // namespace

void add_repair(CommandLine& line) {
  const auto options = std::make_shared<RepairOptions>();
  CLI::App* command = line.add(
      "repair", "Make a mesh bound a solid, each step told; needs no server",
      "  affskel-client repair scan.ply -o scan.off\n"
      "  affskel-client repair scan.off --repair fill=250 -o closed.off   # holes up to 250 round\n"
      "  affskel-client repair scan.off --repair wrap -o wrapped.off      # a new surface round all of it\n"
      "Points are welded, triangles turned to agree, holes filled as their rims bend, flaps dropped; what is sound\n"
      "stays as it is",
      [options](Context& context) { run_repair(context, *options); });
  command
      ->add_option("FILE", options->file,
                   mesh_kinds() + "; for a wrap points, too (.xyz, .csv, .ply).\n- reads it from stdin")
      ->required()
      ->type_name("");
  add_repair_option(command, options->how,
                    "auto fills holes up to 0.6 of the box's diagonal round, fill=LENGTH up to that\n"
                    "length; wrap, or wrap=ALPHA, takes a new surface round all of it and in its cavities,\n"
                    "which closes hollows narrower than a 220th of the diagonal; none only checks");
  add_isovalue(command, options->reading.isovalue);
  add_format(command, options->format);
  add_output(command, options->output, "Mesh file to write, or -");
}

}  // namespace affskel::client
