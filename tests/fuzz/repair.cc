// The repair of triangles in any state, and of points alone: what it says bounds a solid must be closed, and be taken as one.
#include "core/repair/repair_mesh.h"

#include <array>
#include <cmath>
#include <map>

#include "bytes.h"
#include "core/base/error.h"
#include "core/base/split_mix64.h"
#include "core/solid/solid.h"
#include "targets.h"

namespace affskel::fuzz {
namespace {

constexpr unsigned kMostPoints = 24, kMostTriangles = 48;

// Points on a coarse grid, so that many coincide, lie on edges of others, or in one plane.
core::Mesh soup(Bytes& bytes) {
  core::Mesh mesh;
  const unsigned points = 3 + bytes.below(kMostPoints), triangles = 1 + bytes.below(kMostTriangles);
  for (unsigned v = 0; v < points; ++v) {
    const unsigned x = bytes.below(5), y = bytes.below(5), z = bytes.below(5);
    mesh.points.push_back({double(x), double(y), double(z)});
  }
  for (unsigned t = 0; t < triangles; ++t)
    mesh.triangles.push_back({bytes.below(points), bytes.below(points), bytes.below(points)});
  return mesh;
}

// Points alone, in a box, on a ball or on a circle, rounded to a grid and pressed flat.
core::Mesh cloud(Bytes& bytes) {
  core::SplitMix64 random(bytes.below(256));
  const unsigned points = 90 + bytes.below(160), shape = bytes.below(3);
  const double grid = 1 + bytes.below(40), thin = std::array{1.0, 0.1, 1e-12, 0.0}[bytes.below(4)];
  core::Mesh mesh;
  for (unsigned v = 0; v < points; ++v) {
    core::Vec3 p{random.symmetric(), random.symmetric(), shape == 2 ? 0 : random.symmetric()};
    if (shape > 0) p = (1 / norm(p)) * p;
    mesh.points.push_back({std::round(grid * p.x), std::round(grid * p.y), thin * std::round(grid * p.z)});
  }
  return mesh;
}

void check_closed(const core::Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sense;  // how often an edge is passed one way
  for (const core::Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      if (++sense[{t[k], t[(k + 1) % 3]}] > 1) throw Finding("two triangles pass an edge the same way");
  }
  for (const auto& [edge, times] : sense)
    if (!sense.contains({edge.second, edge.first})) throw Finding("an edge has one triangle alone");
}

void run(std::string_view input) {
  Bytes bytes(input);
  core::RepairOptions options;
  const unsigned how = bytes.below(16);
  options.kind = how == 0 ? core::RepairKind::kWrap : core::RepairKind::kMend;
  if (how == 0) options.alpha = 0.5;
  if (how == 2) options.kind = core::RepairKind::kWrap;
  if (how == 1) options.longest_hole = 3;
  if (how > 8) options.longest_hole = 1e3;
  core::RepairedMesh repaired;
  try {
    repaired = core::repair_mesh(how == 2 ? cloud(bytes) : soup(bytes), options);
  } catch (const core::CoreError&) {
    return;
  }
  if (!repaired.left.empty()) return;
  check_closed(repaired.mesh);
  try {
    core::make_solid(repaired.mesh);
  } catch (const core::CoreError& error) {
    // Two triangles on each other are closed and hold nothing.
    if (std::string_view(error.what()).find("volume") == std::string_view::npos)
      throw Finding(std::string("what was repaired is refused: ") + error.what());
  }
}

// Corners of a cube and its triangles, some left out or turned.
std::vector<std::string> seeds() {
  const std::string head{'\x09', 5, 11},
      corners = {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 0, 0, 4, 4, 0, 4, 4, 4, 4, 0, 4, 4};
  const std::string faces = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                             1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  std::string turned = faces;
  std::swap(turned[0], turned[1]);
  return {head + corners + faces, head + corners + turned, head + corners + faces.substr(0, 30),
          std::string{'\x00', 5, 11} + corners + faces.substr(0, 24), std::string{2, 7, 100, 1, 20, 0}};
}

}  // namespace

const Target kRepair = {"repair", seeds, run, 1000};

}  // namespace affskel::fuzz
