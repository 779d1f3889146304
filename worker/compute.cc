#include "compute.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "available_memory.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"
#include "core/solid/solid_frame.h"
#include "core/text/off_file.h"
#include "field_file.h"
#include "wire/direction_order.h"

namespace affskel::worker {
namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened for reading");
  constexpr std::size_t kStep = std::size_t{1} << 20;
  std::string bytes;
  std::error_code unknown;  // the size of a pipe
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown) bytes.reserve(size + kStep);
  for (std::size_t got = kStep; got == kStep;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kStep);
    file.read(bytes.data() + before, kStep);
    got = static_cast<std::size_t>(file.gcount());
    bytes.resize(before + got);
  }
  if (file.bad()) throw std::runtime_error(path + ": reading failed");
  return bytes;
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

}  // namespace

void compute(const ComputeOptions& options) {
  if (!options.output.empty()) check_field_file(options.output);
  const core::Stopwatch wall;
  const core::OffMesh off = core::read_off(read_file(options.file));
  const core::Solid solid = core::make_solid(off.mesh, {options.repair_mode == "auto", true, options.threads},
                                             off.vertex_line, off.triangle_line);
  for (const core::MeshNote& note : solid.notes) {
    std::fprintf(stderr, "%s: %s\n", options.file.c_str(), note.message.c_str());
  }
  core::LatticeOptions lattice_options;
  lattice_options.spacing = options.spacing;
  lattice_options.target_points = options.points;
  lattice_options.frame = core::solid_frame(solid, core::parse_frame(options.frame));
  lattice_options.threads = options.threads;
  lattice_options.memory_budget = available_memory();
  lattice_options.point_bytes = core::kErosionBytesPerPoint;
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
  if (!options.output.empty()) {
    write_field_file(options.output, solid, lattice, directions, erosion.field());
  }
  std::fprintf(
      stderr,
      "N=%zu R=%u K=%zu v0=%.17g prepare_s=%.6f trees_s=%.6f sweep_s=%.6f wall_s=%.6f peak_rss_mb=%.1f\n",
      solid.mesh.triangles.size(), lattice.points, directions.size(), solid.volume, prepare_s, cost.trees_s,
      cost.sweep_s, wall_s, peak_rss_mb());
}

}  // namespace affskel::worker
