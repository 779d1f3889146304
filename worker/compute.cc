#include "compute.h"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "core/directions.h"
#include "core/erosion.h"
#include "core/error.h"
#include "core/lattice.h"
#include "core/mesh_io.h"
#include "core/solid.h"
#include "core/solid_frame.h"
#include "wire/direction_order.h"

namespace affskel::worker {
namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened for reading");
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (file.bad()) throw std::runtime_error(path + ": reading failed");
  return std::move(bytes).str();
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// All directions in the order that the service works in, or in a random one.
std::vector<std::uint32_t> work_order(std::size_t count, bool shuffle) {
  const std::uint64_t stride = wire::direction_stride(count);
  std::vector<std::uint32_t> list(count);
  for (std::size_t p = 0; p < count; ++p) {
    list[p] = static_cast<std::uint32_t>(wire::direction_at(p, stride, count));
  }
  if (shuffle) std::shuffle(list.begin(), list.end(), std::mt19937_64(std::random_device{}()));
  return list;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

bool ends_with(const std::string& text, const std::string& tail) {
  return text.size() >= tail.size() && text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

void check_output(const std::string& path) {
  if (path.empty() || ends_with(path, ".csv") || ends_with(path, ".dat")) return;
  throw core::CoreError(core::CoreError::Code::kBadInput,
                        "output " + path + ": the extension must be .csv or .dat");
}

std::system_error output_error(const std::string& path, const char* what) {
  return {errno, std::generic_category(), path + ": " + what};
}

void write_field(const std::string& path, const core::Solid& solid, const core::Lattice& lattice,
                 const core::DirectionSet& directions, const core::ErosionField& field) {
  const File file(std::fopen(path.c_str(), "w"), &std::fclose);
  if (!file) throw output_error(path, "cannot be opened for writing");
  const bool csv = ends_with(path, ".csv");
  if (csv) std::fputs("x,y,z,E,nx,ny,nz,direction\n", file.get());
  const core::SamplePlaces places(solid, lattice);
  const double volume_unit = std::ldexp(1.0, 3 * solid.exponent);
  for (const core::LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const core::Vec3 x = places.at(run.start[0], run.start[1], run.start[2] + n);
      const core::FieldValue value = field.value(run.first + n);
      const core::Vec3& d = directions[value.direction];
      const double erosion = value.erosion * volume_unit;
      if (csv) {
        std::fprintf(file.get(), "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%u\n", x.x, x.y, x.z, erosion,
                     d.x, d.y, d.z, value.direction);
      } else {
        std::fprintf(file.get(), "%.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", x.x, x.y, x.z, erosion, d.x,
                     d.y, d.z);
      }
    }
  }
  if (std::fflush(file.get()) != 0 || std::ferror(file.get()) != 0)
    throw output_error(path, "writing failed");
}

}  // namespace

void compute(const ComputeOptions& options) {
  check_output(options.output);
  const Stopwatch wall;
  const core::OffMesh off = core::read_off(read_file(options.file));
  const core::Solid solid =
      core::make_solid(off.mesh, {options.repair_mode == "auto", true}, off.vertex_line, off.triangle_line);
  for (const core::MeshNote& note : solid.notes) {
    std::fprintf(stderr, "%s: %s\n", options.file.c_str(), note.message.c_str());
  }
  core::LatticeOptions lattice_options;
  lattice_options.spacing = options.spacing;
  lattice_options.target_points = options.points;
  lattice_options.frame = core::solid_frame(solid, core::parse_frame(options.frame));
  const core::Lattice lattice = core::make_lattice(solid, lattice_options);
  core::DirectionOptions direction_options;
  direction_options.frame = lattice_options.frame;
  const core::DirectionSet directions = core::make_directions(solid, options.directions, direction_options);
  core::ErosionOptions erosion_options;
  erosion_options.threads = options.threads;
  erosion_options.prune = options.prune;
  core::Erosion erosion(solid, lattice, directions, erosion_options);
  const double prepare_s = wall.seconds();
  core::ExecutionContext context;
  erosion.run(work_order(directions.size(), options.shuffle), context);
  const core::ErosionCost cost = erosion.cost();
  const double wall_s = wall.seconds();
  if (!options.output.empty()) write_field(options.output, solid, lattice, directions, erosion.field());
  std::fprintf(
      stderr,
      "N=%zu R=%u K=%zu v0=%.17g prepare_s=%.6f trees_s=%.6f sweep_s=%.6f wall_s=%.6f peak_rss_mb=%.1f\n",
      solid.mesh.triangles.size(), lattice.points, directions.size(), solid.volume, prepare_s, cost.trees_s,
      cost.sweep_s, wall_s, peak_rss_mb());
}

}  // namespace affskel::worker
