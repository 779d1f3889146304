#include "core/mesh/perturb.h"

#include <nlohmann/json.hpp>

#include "client/commands/commands.h"
#include "client/commands/destination.h"
#include "client/commands/shapes.h"
#include "client/exporters/atomic_file.h"
#include "client/exporters/numbers.h"
#include "client/exporters/shape_writer.h"
#include "client/number_list.h"
#include "core/base/error.h"
#include "core/mesh/coincident_points.h"
#include "core/spatial/self_intersection.h"

namespace affskel::client {
namespace {

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

// The surface crosses itself when it does so as one whose corners at the same place are joined.
bool crosses_itself(core::Mesh mesh) {
  const std::vector<std::uint32_t> first = core::first_coincident_point(mesh.points);
  for (core::Triangle& t : mesh.triangles) {
    for (std::uint32_t& corner : t) corner = first[corner];
  }
  core::SelfIntersectionOptions options;
  options.max_pairs = 1;
  return !core::self_intersections(mesh, options).empty();
}

}  // namespace

void run_perturb(Console& console, const PerturbOptions& options) {
  if (options.noise.empty() == !options.sigma) {
    throw ClientError(ExitCode::kUsage, "give either --noise (a share of the box diagonal) or --sigma");
  }
  const double fraction = options.noise.empty() ? 0 : fraction_of(options.noise);
  const Destination destination = destination_of(options.output, options.format, console);
  ShapeFile shape = read_shape(options.file);
  if (!shape.is_surface()) {
    throw ClientError(ExitCode::kBadInput, "has no triangles; noise is for the vertices of a mesh",
                      options.file);
  }
  const FileFormat format = choose_format(destination, shape_formats(shape), "surface");
  const double diagonal = core::box_diagonal(shape.mesh());
  const double sigma = options.noise.empty() ? *options.sigma : fraction * diagonal;
  try {
    shape.off.mesh = core::perturb(shape.mesh(), {sigma, options.seed});
  } catch (const core::CoreError& error) {
    throw error_from_core(error, options.file);
  }
  // What was true of the old places (E, normals) is not of the new ones.
  tell_what_is_lost(console, shape, FileFormat::kOff, destination.name());
  shape.columns.clear();

  const std::string noise = "Gaussian noise of standard deviation " + shortest(sigma) +
                            " in every coordinate, seed " + std::to_string(options.seed);
  AtomicFile file(destination.file);
  write_shape(format, shape, {noise}, file);
  file.commit();
  console.note("wrote " + destination.name() + " (" + counts_text(shape) + ", sigma " + rounded(sigma, 6) +
               ", seed " + std::to_string(options.seed) + ")");
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

}  // namespace affskel::client
