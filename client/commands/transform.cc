#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/cli/affine_steps.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/shape_options.h"
#include "client/files/read/read_shape.h"
#include "client/files/write/shape_writer.h"
#include "client/operations/shape_notices.h"
#include "core/base/error.h"
#include "core/mesh/map_mesh.h"

namespace affskel::client {
namespace {

struct TransformOptions {
  std::string file, output, format;
  bool inverse = false;
};

using nlohmann::ordered_json;

// The three columns of a normal: names that begin with n and differ in one letter, as nx ny nz or nx_a ny_a
// nz_a do; `first` is the one with the x.  Empty when the column is not the first of three.
std::vector<PointColumn*> normal_columns(ShapeFile& shape, const std::string& first) {
  for (std::size_t at = first.find('x', 1); at != std::string::npos; at = first.find('x', at + 1)) {
    std::vector<PointColumn*> found;
    for (const char letter : {'x', 'y', 'z'}) {
      std::string name = first;
      name[at] = letter;
      for (PointColumn& column : shape.columns) {
        if (column.name == name) found.push_back(&column);
      }
    }
    if (found.size() == 3) return found;
  }
  return {};
}

// Normals as those of planes, renormalised; E as a volume; everything else stays.
void map_columns(const core::AffineMap& map, ShapeFile& shape) {
  const double volumes = std::abs(core::determinant(map));
  const core::NormalMap normals(map);
  for (PointColumn& column : shape.columns) {
    if (column.name == "E") {
      for (double& e : column.values) e *= volumes;
    }
    if (column.name.front() != 'n' && column.name.front() != 'N') continue;
    const std::vector<PointColumn*> n = normal_columns(shape, column.name);
    if (n.empty()) continue;
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      const core::Vec3 mapped = normals({n[0]->values[i], n[1]->values[i], n[2]->values[i]});
      for (int c = 0; c < 3; ++c) n[static_cast<std::size_t>(c)]->values[i] = mapped[c];
    }
    for (PointColumn* part : n) part->whole = false;
  }
}

std::vector<double> numbers_of(const core::AffineMap& map) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < 3; ++i) {
    const core::Vec3& row = map.rows[i];
    numbers.insert(numbers.end(), {row.x, row.y, row.z, map.shift[static_cast<int>(i)]});
  }
  return numbers;
}

std::string comment_for(const std::vector<double>& numbers) {
  std::string text = "mapped by the affine map";
  for (const double number : numbers) text += " " + base::to_text(number);
  return text;
}

void run_transform(Context& context, const TransformOptions& options, const std::vector<AffineStep>& steps) {
  Console& console = context.console();
  if (steps.empty()) {
    throw ClientError(ExitCode::kUsage,
                      "no map was given; use --matrix, --scale, --rotate, --translate or --shear");
  }
  core::AffineMap map = affine_map_of(steps);
  if (options.inverse) map = core::inverse(map);
  const Destination destination = destination_of(options.output, options.format, console);
  ShapeFile shape =
      context.within_budget(Budget::Work::kReading, options.file, [&] { return read_shape(options.file); });
  const FileFormat format =
      choose_format(destination, shape_formats(shape), shape.is_surface() ? "surface" : "file of points");
  try {
    shape.off.mesh = core::map_mesh(map, shape.mesh());
  } catch (const core::CoreError& error) {
    throw error_from_core(error, shape.path);
  }
  map_columns(map, shape);
  say(console, lost_in_format(shape, format, destination.name()));

  const std::vector<double> numbers = numbers_of(map);
  base::AtomicFile file(destination.file);
  write_into(file,
             [&](const WriteBytes& write) { write_shape(format, shape, {comment_for(numbers)}, write); });
  file.commit();
  const double det = core::determinant(map);
  console.note("wrote " + destination.name() + " (" + counts_text(shape) + ", volumes times " +
               base::rounded(std::abs(det), 6) + (det < 0 ? ", mirrored" : "") + ")");
  console.document({{"file", options.output},
                    {"points", shape.mesh().points.size()},
                    {"triangles", shape.mesh().triangles.size()},
                    {"determinant", det},
                    {"matrix", numbers}});
}

}  // namespace

void add_transform(CommandLine& line) {
  const auto options = std::make_shared<TransformOptions>();
  const auto steps = std::make_shared<AffineStepOptions>();
  CLI::App* command = line.add(
      "transform", "Affine map of a mesh or a skeleton; needs no server",
      "  affskel-client transform body.off -o sheared.off --shear y+=z\n"
      "  affskel-client transform body.off -o moved.off --rotate z:30 --scale 2,1,0.5 --translate 0,0,100\n"
      "  affskel-client transform sheared.ply -o back.ply --shear y+=z --inverse\n"
      "Steps are taken in the order given. Normals are mapped as those of planes, E as a volume; H and "
      "other\n"
      "columns stay. A mirrored surface is turned over, so that it stays outward.",
      [options, steps](Context& context) { run_transform(context, *options, steps->in_order()); });
  add_file(
      command, "FILE", options->file,
      "Mesh, surface, skeleton or field: .off .ply .obj .stl .vtp .csv .xyz .dat;\n- reads it from stdin, of a kind that its content tells");
  add_output(command, options->output,
             "File to write: .off .ply .obj .stl .vtp for triangles,\n.csv .ply .off .xyz .vtp for points");
  add_format(command, options->format);
  steps->add_to(command);
  command->add_flag("--inverse", options->inverse, "The inverse of the whole");
}

}  // namespace affskel::client
