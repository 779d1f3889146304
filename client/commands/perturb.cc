#include "core/mesh/perturb.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/cli/number_parsers.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/shape_options.h"
#include "client/files/read/read_shape.h"
#include "client/files/write/shape_writer.h"
#include "client/operations/shape_notices.h"
#include "core/base/error.h"
#include "core/files/read/parse_shape.h"
#include "core/mesh/box.h"
#include "core/mesh/coincident_points.h"
#include "core/spatial/self_intersection.h"

namespace affskel::client {
namespace {

struct PerturbOptions {
  std::string file, output, format;
  std::string noise;            // share of the box diagonal, "0.5%" or "0.005"; empty = sigma
  std::optional<double> sigma;  // mesh units
  std::uint64_t seed = 1;
};

// "0.5%" or "0.005"
double fraction_of(const std::string& text) {
  const std::optional<double> share = parse_share(text);
  if (!share || *share < 0) {
    throw ClientError(
        ExitCode::kUsage,
        "--noise: expected a share of the box diagonal >= 0 as in 0.5% or 0.005, not '" + text + "'");
  }
  return *share;
}

// Whether the surface crosses itself once corners at the same place are joined.
bool crosses_itself(core::Mesh mesh) {
  const std::vector<std::uint32_t> first = core::first_coincident_point(mesh.points);
  for (core::Triangle& t : mesh.triangles) {
    for (std::uint32_t& corner : t) corner = first[corner];
  }
  core::SelfIntersectionOptions options;
  options.max_pairs = 1;
  return !core::self_intersections(mesh, options).empty();
}

void run_perturb(Context& context, const PerturbOptions& options) {
  Console& console = context.console();
  if (options.noise.empty() == !options.sigma) {
    throw ClientError(ExitCode::kUsage, "give either --noise (a share of the box diagonal) or --sigma");
  }
  const double fraction = options.noise.empty() ? 0 : fraction_of(options.noise);
  const Destination destination = destination_of(options.output, options.format, console);
  ShapeFile shape =
      context.within_budget(Budget::Work::kReading, options.file, [&] { return read_shape(options.file); });
  if (shape.mesh().triangles.empty()) {
    throw ClientError(ExitCode::kBadInput, "has no triangles; noise is for the vertices of a mesh",
                      shape.path);
  }
  const FileFormat format = choose_format(destination, shape_formats(shape), "surface");
  const double diagonal = core::box_diagonal(shape.mesh());
  const double sigma = options.noise.empty() ? *options.sigma : fraction * diagonal;
  try {
    shape.off.mesh = core::perturb(shape.mesh(), {sigma, options.seed});
  } catch (const core::CoreError& error) {
    throw error_from_core(error, shape.path);
  }
  // What was true of the old places (E, normals) is not of the new ones.
  // Nor have curves vertices of a mesh.
  shape.segments.clear();
  say(console, lost_in_format(shape, FileFormat::kOff, destination.name()));
  shape.columns.clear();

  const std::string noise = "Gaussian noise of standard deviation " + base::to_text(sigma) +
                            " in every coordinate, seed " + std::to_string(options.seed);
  base::AtomicFile file(destination.file);
  write_into(file, [&](const WriteBytes& write) { write_shape(format, shape, {noise}, write); });
  file.commit();
  console.note("wrote " + destination.name() + " (" + counts_text(shape) + ", sigma " +
               base::rounded(sigma, 6) + ", seed " + std::to_string(options.seed) + ")");
  const bool crosses = crosses_itself(shape.mesh());
  if (crosses) {
    console.warning(destination.name() +
                    ": the surface crosses itself; it can still be computed, but what is inside is "
                    "ambiguous where it does");
  }
  console.document({{"file", options.output},
                    {"points", shape.mesh().points.size()},
                    {"triangles", shape.mesh().triangles.size()},
                    {"diagonal", diagonal},
                    {"sigma", sigma},
                    {"seed", options.seed},
                    {"self_intersecting", crosses}});
}

}  // namespace

void add_perturb(CommandLine& line) {
  const auto options = std::make_shared<PerturbOptions>();
  CLI::App* command =
      line.add("perturb", "Gaussian noise on the vertices of a mesh; needs no server",
               "  affskel-client perturb body.off -o noisy.off --noise 0.5% --seed 7\n"
               "  affskel-client perturb body.off -o noisy.off --sigma 12\n"
               "Every vertex moves by sigma times a normal number in x, y and z; vertices at one "
               "place move together.\n"
               "The same seed gives the same noise on every machine.",
               [options](Context& context) { run_perturb(context, *options); });
  add_file(command, "FILE", options->file,
           "Mesh:" + core::listed(core::mesh_extensions()) + ", also by gzip or zstd; - reads it from stdin");
  command->get_option("FILE")->check(mesh_file());
  add_output(command, options->output, "File to write: .off .ply .obj .stl .vtp");
  add_format(command, options->format);
  CLI::Option* noise =
      command->add_option("--noise", options->noise, "Sigma as a share of the box diagonal: 0.5% or 0.005")
          ->check(non_empty())
          ->type_name("SHARE");
  command->add_option("--sigma", options->sigma, "Sigma in mesh units")
      ->check(positive_number())
      ->excludes(noise)
      ->type_name("S");
  command->add_option("--seed", options->seed, "Whole number")
      ->check(whole_number(0, ~std::uint64_t{0}))
      ->capture_default_str()
      ->type_name("N");
}

}  // namespace affskel::client
