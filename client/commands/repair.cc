#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/cli/number_parsers.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/files/read/input_file.h"
#include "client/files/read/read_shape.h"
#include "client/files/write/shape_writer.h"
#include "client/operations/repair.h"
#include "client/text/key_line.h"
#include "client/text/shell_quoted.h"

namespace affskel::client {
namespace {

struct RepairOptions {
  std::string file, output, format, how = "auto";
};

[[noreturn]] void no_repair(const std::string& text) {
  throw ClientError(
      ExitCode::kUsage,
      "--repair '" + text + "': auto, none, fill=LENGTH, wrap or wrap=ALPHA is needed, in units of the mesh");
}

RepairChoice choice_of(const std::string& text) {
  using Kind = RepairChoice::Kind;
  if (text == "auto") return {};
  if (text == "none") return {Kind::kNone};
  if (text == "wrap") return {Kind::kWrap};
  const std::size_t sign = text.find('=');
  const auto value =
      sign == std::string::npos ? std::nullopt : parse_number(std::string_view(text).substr(sign + 1));
  if (!value || !(*value > 0)) no_repair(text);
  if (text.starts_with("fill=")) return {Kind::kFill, *value};
  if (text.starts_with("wrap=")) return {Kind::kWrap, 0, *value};
  no_repair(text);
}

// A wrap takes points, too.
core::Mesh mesh_of(const std::string& file, const RepairChoice& choice) {
  if (choice.kind == RepairChoice::Kind::kWrap) return read_shape(file).mesh();
  return read_named_input(file).off.mesh;
}

// What the other ways are, to who has met the end of one.
[[noreturn]] void advise(const Context& context, const std::string& file, const Repair& done) {
  const std::string again = "repair " + shell_quoted(file) + " --repair ";
  throw ClientError(
      ExitCode::kBadInput,
      done.left + "; fill them by: " +
          context.next_command(again + "fill=" + base::rounded(1.01 * done.longest_left, 3) +
                               " -o filled.off") +
          ", or take a new surface round all of it: " + context.next_command(again + "wrap -o wrapped.off"),
      file);
}

void run_repair(Context& context, const RepairOptions& options) {
  Console& console = context.console();
  const RepairChoice choice = choice_of(options.how);
  const Destination destination = destination_of(options.output, options.format, console);
  ShapeFile shape;
  shape.off.mesh = mesh_of(options.file, choice);
  Repair done = repair(shape.off.mesh, options.file, choice);
  if (!done.left.empty()) advise(context, options.file, done);
  shape.off.mesh = std::move(done.mesh);
  const FileFormat format = choose_format(destination, shape_formats(shape), "mesh");
  base::AtomicFile file(destination.file);
  write_into(file, [&](const WriteBytes& write) { write_shape(format, shape, {"repaired"}, write); });
  file.commit();

  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  std::string text;
  for (const core::RepairStep& step : done.steps) {
    text += key_line(step.code, step.message);
    steps.push_back({{"code", step.code}, {"count", step.count}, {"message", step.message}});
  }
  if (done.steps.empty()) text += key_line("sound", "yes");
  text += key_line("triangles", std::to_string(shape.mesh().triangles.size()));
  text += key_line("volume", base::plain(done.volume, base::kMeasureDigits));
  console.result(text);
  console.note("wrote " + destination.name());
  console.document({{"file", options.output},
                    {"repair", options.how},
                    {"steps", steps},
                    {"filled_share", done.filled_share},
                    {"points", shape.mesh().points.size()},
                    {"triangles", shape.mesh().triangles.size()},
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
                   "Geomview OFF text, .ply, .obj, .stl or .vtp; for a wrap points, too (.xyz, .ply)")
      ->required()
      ->type_name("");
  command
      ->add_option(
          "--repair", options->how,
          "auto: fill holes no longer round than 0.6 of the box's diagonal; fill=LENGTH:\nup to that length; "
          "wrap: wrap it in a new surface that closes hollows narrower\nthan a 220th of the diagonal, or "
          "wrap=ALPHA; none: only check")
      ->capture_default_str()
      ->type_name("HOW");
  add_format(command, options->format);
  add_output(command, options->output, "Mesh file to write, or -");
}

}  // namespace affskel::client
