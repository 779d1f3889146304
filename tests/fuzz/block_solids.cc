// Random solids of blocks: their volume, pieces and field against sums over their cells.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/number_text.h"
#include "block_solid.h"
#include "bytes.h"
#include "core/base/error.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/lattice/lattice.h"
#include "core/repair/repair_mesh.h"
#include "core/solid/solid.h"
#include "targets.h"

namespace affskel::fuzz {
namespace {

constexpr std::array<double, 8> kSides = {1, 1, 0.5, 2, 1e-2, 1e-4, 1e-6, 30};
constexpr unsigned kMostCells = 4;  // along an axis
constexpr std::uint64_t kPoints = 60;
constexpr std::uint64_t kMostLines = 200'000;  // plates far apart would need millions for so many points
constexpr double kRelative = 1e-9, kOfVolume = 1e-10;
// Heights are rounded to 2^-44 of the size: a section moves by that.
constexpr double kHeight = 0x1p-42;

BlockSolid solid_of(Bytes& bytes) {
  BlockSolid solid;
  for (std::vector<double>& planes : solid.planes) {
    planes.assign(1, 0);
    const unsigned cells = 1 + bytes.below(kMostCells);
    for (unsigned c = 0; c < cells; ++c) planes.push_back(planes.back() + kSides[bytes.below(kSides.size())]);
  }
  const std::size_t cells = solid.cells(0) * solid.cells(1) * solid.cells(2);
  for (std::size_t c = 0; c < cells; c += 8) {
    const unsigned byte = bytes.byte();
    for (unsigned b = 0; b < 8 && c + b < cells; ++b) solid.full.push_back((byte >> b & 1) != 0);
  }
  return solid;
}

// As `submit` makes it one: where parts touch along an edge, repaired.
core::Solid checked_solid(const core::Mesh& mesh) {
  try {
    return core::make_solid(mesh);
  } catch (const core::CoreError&) {
    const core::RepairedMesh repaired = core::repair_mesh(mesh);
    if (!repaired.left.empty()) throw Finding("a solid of blocks is not repaired: " + repaired.left);
    return core::make_solid(repaired.mesh);
  }
}

// @param slack more than relative errors.
void check_close(double found, double expected, double slack, const char* what) {
  if (std::fabs(found - expected) <= kRelative * expected + slack) return;
  throw Finding(std::string(what) + " is " + base::to_text(found) + ", not " + base::to_text(expected));
}

// By which E may be off.
double slack_of(const BlockSolid& solid) {
  const double x = solid.planes[0].back(), y = solid.planes[1].back(), z = solid.planes[2].back();
  return kOfVolume * solid.volume() + kHeight * std::max({x, y, z}) * std::max({x * y, y * z, z * x});
}

bool is_on_plane(const BlockSolid& solid, const core::Vec3& x) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double plane : solid.planes[axis])
      if (std::fabs(plane - x[static_cast<int>(axis)]) < 1e-9 * solid.planes[axis].back()) return true;
  return false;
}

void check_field(const BlockSolid& blocks, const core::Solid& solid) {
  core::LatticeOptions sampling;
  sampling.target_points = kPoints;
  sampling.max_lines = kMostLines;
  const core::Lattice lattice = core::make_lattice(solid, sampling);
  const core::DirectionSet directions = core::make_directions(solid, "triangles");
  core::Erosion erosion(solid, lattice, directions, {1, false, true});
  core::ExecutionContext context;
  std::vector<std::uint32_t> all(directions.size());
  std::iota(all.begin(), all.end(), 0U);
  erosion.run(all, context);
  const double unit = std::pow(solid.scale(), 3), slack = slack_of(blocks);
  const core::SamplePlaces places(solid, lattice);
  std::uint32_t rank = 0;
  for (const core::LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n, ++rank) {
      const core::Vec3 x = places.at(run.start[0], run.start[1], run.start[2] + n);
      if (is_on_plane(blocks, x)) continue;
      const double expected = blocks.axis_erosion(x);
      if (expected == 0) throw Finding("a sample point lies outside");
      check_close(unit * erosion.field().value(rank).erosion, expected, slack, "E");
    }
  }
}

void run(std::string_view input) {
  Bytes bytes(input);
  const BlockSolid blocks = solid_of(bytes);
  if (blocks.volume() == 0) return;
  const core::Solid solid = checked_solid(blocks.mesh());
  // Parts next to nothing beside the others are left out, and that is told.
  if (std::ranges::any_of(solid.notes, [](const core::MeshNote& note) { return note.code == "specks"; }))
    return;
  check_close(solid.volume, blocks.volume(), kOfVolume * blocks.volume(), "the volume");
  if (solid.solid_volume.size() != blocks.solids())
    throw Finding("it has " + std::to_string(solid.solid_volume.size()) + " solids, not " +
                  std::to_string(blocks.solids()));
  try {
    check_field(blocks, solid);
  } catch (const core::CoreError& error) {
    // A plate may lie between the points of a lattice.
    if (error.code() != core::CoreError::Code::kLimit && error.code() != core::CoreError::Code::kBadInput)
      throw;
  }
}

std::vector<std::string> seeds() {
  return {
      {1, 1, 0, 0, 1, 0, 0, 1, 0, 0, '\x96'},  // two pairs of cubes that touch along edges
      {2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, '\xff', '\xdf', '\xff', '\xff'},  // a cavity
      {3, 0, 5, 1, 2, 0, 0, 1, 4, '\xb7', '\x5d', '\xe3'},
  };
}

}  // namespace

const Target kBlockSolids = {"block_solids", seeds, run, 400};

}  // namespace affskel::fuzz
