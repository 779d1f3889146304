#include "compute.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "base/read_file.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/version.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/files/field_file.h"
#include "core/files/read/parse_shape.h"
#include "core/files/read/unpack.h"
#include "core/infimum/piece_input.h"
#include "core/infimum/refine.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"
#include "core/solid/solid_frame.h"
#include "core/text/off_file.h"
#include "job/available_memory.h"
#include "wire/direction_order.h"
#include "wire/sha256.h"

namespace affskel::worker {
namespace {

std::string read(const std::string& path) {
  try {
    return base::read_file(path);
  } catch (const base::FileError& error) {
    const bool opened = error.action() == "cannot read";
    throw std::runtime_error(path + (opened ? ": reading failed" : ": cannot be opened for reading"));
  }
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string six_decimals(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6f", value);
  return text;
}

// All directions in the order that the service works in, or in a random one.
std::vector<std::uint32_t> work_order(std::size_t count, bool shuffle) {
  std::vector<std::uint32_t> list = wire::directions_in_order(count);
  if (shuffle) std::shuffle(list.begin(), list.end(), std::mt19937_64(std::random_device{}()));
  return list;
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

core::FileFormat output_format(const std::string& path) {
  std::string names;
  for (const core::FileFormat format : core::field_formats()) {
    if (extension_of(path) == core::extension_of(format)) return format;
    names += (names.empty() ? "" : ", ") + std::string(core::extension_of(format));
  }
  throw std::invalid_argument(path + ": cannot write the field as '" + extension_of(path) +
                              "'; possible are " + names);
}

// The mesh, and the hash of the text that the client would submit.
struct ReadMesh {
  core::OffMesh off;
  std::string sha256;
};

ReadMesh read_mesh(const std::string& path) {
  std::string bytes = read(path);
  if (!core::compression_of(bytes).empty()) bytes = core::unpack(bytes);
  core::MeshFile file = core::parse_mesh_file(extension_of(std::string(core::unpacked_name(path))), bytes);
  const std::string sha256 = wire::sha256_hex(file.off_text ? bytes : core::write_off(file.off.mesh));
  return {std::move(file.off), sha256};
}

core::LatticeGrid grid_of(const core::Solid& solid, const core::Lattice& lattice) {
  const core::SamplePlaces places(solid, lattice);
  return {places.origin(), places.axes(), lattice.grid.dims};
}

void check_output(const std::string& path, const core::LatticeGrid& grid) {
  try {
    core::check_places(output_format(path), grid);
  } catch (const core::CoreError& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
}

core::FileFacts facts_of(const ComputeOptions& options, const std::string& sha256, const core::Solid& solid,
                         const core::Lattice& lattice, std::size_t directions) {
  const auto number = [](const char* key, double value) {
    return core::FileFact{key, base::to_text(value), value};
  };
  return {{"content", "erosion field of " + std::filesystem::path(options.file).stem().string()},
          {"job", "none, affskel-worker compute"},
          {"mesh_sha256", sha256},
          number("v0", solid.volume),
          number("spacing", lattice.spacing),
          number("sample_points", lattice.points),
          {"directions", options.directions + " (" + std::to_string(directions) + ")"},
          {"minimum", options.minimum == "infimum" ? "over all directions" : "over these directions"},
          {"frame", options.frame},
          {"core_version", core::kCoreVersion},
          {"units", core::kFileUnits}};
}

// A field over a set of directions, or over all.
struct Field {
  const core::DirectionSet& directions;
  const core::ErosionField& set;
  std::vector<core::LeastChord> infimum;  // empty unless it was asked for

  // Scaled units.
  core::FieldSample at(std::uint32_t point) const {
    if (!infimum.empty()) {
      const core::LeastChord& least = infimum[point];
      return {least.erosion, least.slope, least.normal, 0, 0, static_cast<std::uint32_t>(least.kind())};
    }
    const core::FieldValue value = set.value(point);
    return {value.erosion, value.area, directions[value.direction], value.direction, 0, 0};
  }
};

// In mesh units, in lattice order.
void write_field(const std::string& path, const core::FileFacts& facts, const core::Solid& solid,
                 const core::Lattice& lattice, const Field& field) {
  base::AtomicFile file(path);
  core::FieldFile out(output_format(path), file, grid_of(solid, lattice), solid.volume, facts,
                      {.all_directions = !field.infimum.empty()});
  const double volume_unit = std::ldexp(1.0, 3 * solid.exponent),
               area_unit = std::ldexp(1.0, 2 * solid.exponent);
  for (const core::LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      core::FieldSample sample = field.at(run.first + n);
      sample.erosion *= volume_unit;
      sample.slope *= area_unit;
      out.put({run.start[0], run.start[1], run.start[2] + n}, sample);
    }
  }
  out.finish();
  file.commit();
}

}  // namespace

void compute(const ComputeOptions& options) {
  if (!options.output.empty()) output_format(options.output);
  const core::Stopwatch wall;
  const ReadMesh read = read_mesh(options.file);
  const core::OffMesh& off = read.off;
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
  const bool infimum = options.minimum == "infimum";
  lattice_options.point_bytes = core::kErosionBytesPerPoint + (infimum ? core::kRefineBytesPerPoint : 0);
  const core::Lattice lattice = core::make_lattice(solid, lattice_options);
  if (!options.output.empty()) check_output(options.output, grid_of(solid, lattice));
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
  Field field{directions, erosion.field(), {}};
  std::string refine_s;
  if (infimum) {
    const core::Stopwatch refining;
    field.infimum = core::refine(core::PieceInput(solid, options.threads), lattice, directions, field.set,
                                 options.threads, context);
    refine_s = " refine_s=" + six_decimals(refining.seconds());
  }
  const double wall_s = wall.seconds();
  if (!options.output.empty()) {
    write_field(options.output, facts_of(options, read.sha256, solid, lattice, directions.size()), solid,
                lattice, field);
  }
  std::fprintf(stderr,
               "N=%zu R=%u K=%zu v0=%.17g prepare_s=%.6f trees_s=%.6f sweep_s=%.6f%s wall_s=%.6f "
               "peak_rss_mb=%.1f\n",
               solid.mesh.triangles.size(), lattice.points, directions.size(), solid.volume, prepare_s,
               cost.trees_s, cost.sweep_s, refine_s.c_str(), wall_s, peak_rss_mb());
}

}  // namespace affskel::worker
