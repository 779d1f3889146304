// Prints hashes of every bit of the fields of some solids, of their sheets of chords with the barriers there, and
// of their ridges: equal output means equal fields and sheets.
// Usage: field_hash [THREADS]
#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "core/barrier/barriers.h"
#include "core/chords/chord_sheet.h"
#include "core/curve/curve_skeleton.h"
#include "core/erosion/erosion.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/ridge/ridge_sheet.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/shocks/shock_operator.h"
#include "core/solid/solid_frame.h"

namespace {

using affskel::core::Mesh;

// FNV-1a over 64-bit words.
class Hash {
 public:
  void add(std::uint64_t word) { state_ = (state_ ^ word) * 1099511628211ULL; }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 14695981039346656037ULL;
};

Mesh hollow_ball() {
  Mesh mesh = affskel::core::make_sphere(3, 320);
  const Mesh inner = affskel::core::make_sphere(1, 80);
  const auto offset = static_cast<std::uint32_t>(mesh.points.size());
  for (const auto& p : inner.points) mesh.points.push_back(p);
  for (const auto& t : inner.triangles)
    mesh.triangles.push_back({t[0] + offset, t[2] + offset, t[1] + offset});
  return mesh;
}

void add_sheet(const affskel::core::SheetMesh& sheet, Hash& hash) {
  using namespace affskel::core;
  for (const SheetVertex& vertex : sheet.vertices) {
    for (const Vec3& v : {vertex.position, vertex.normal_a, vertex.normal_b}) {
      for (int k = 0; k < 3; ++k) hash.add(v[k]);
    }
    for (const double value : {vertex.erosion, vertex.strength, vertex.area}) hash.add(value);
  }
  for (const Triangle& triangle : sheet.triangles) {
    for (const std::uint32_t corner : triangle) hash.add(std::uint64_t{corner});
  }
  for (const Segment& segment : sheet.segments) {
    for (const std::uint32_t end : segment) hash.add(std::uint64_t{end});
  }
}

std::uint64_t chords_hash(const affskel::core::Solid& solid, const affskel::core::Lattice& lattice,
                          const affskel::core::FrameField& field, unsigned threads) {
  using namespace affskel::core;
  const ChordSheet sheet = chord_sheet(solid, lattice, field);
  Hash hash;
  for (const ChordShock& shock : sheet.shocks) {
    hash.add(std::uint64_t{shock.point});
    hash.add(shock.turn);
  }
  add_sheet(sheet, hash);
  std::vector<SheetPlace> places;
  for (const SheetVertex& v : sheet.vertices)
    places.push_back({scaled_place(lattice, (1 / lattice.spacing) * v.position), v.normal_a, v.normal_b});
  BarrierOptions options;
  options.directions = 162;
  options.threads = threads;
  for (const double barrier : barriers(solid, places, options)) hash.add(barrier);
  return hash.value();
}

std::uint64_t ridge_hash(const affskel::core::Solid& solid, const affskel::core::Lattice& lattice,
                         const affskel::core::FrameField& field, unsigned threads) {
  using namespace affskel::core;
  const RidgeBasis basis = ridge_basis(solid, lattice, field, threads);
  Hash hash;
  const RidgeSheet ridge = ridge_sheet(solid, lattice, field, basis);
  RidgeSheet drawn = ridge;
  draw_out(drawn);
  add_sheet(drawn, hash);
  const CurveSkeleton curve = curve_skeleton(
      {solid, lattice, basis, ridge, limb_surface(solid, lattice, threads)}, {.threads = threads});
  add_sheet(curve, hash);
  for (const double distance : curve.distance) hash.add(distance);
  for (const double beyond : curve.beyond) hash.add(beyond);
  return hash.value();
}

void print_hash(const char* name, const Mesh& mesh, const std::string& directions, unsigned threads,
                affskel::core::FrameKind frame = affskel::core::FrameKind::kAxis) {
  using namespace affskel::core;
  const Solid solid = make_solid(mesh);
  LatticeOptions lattice_options;
  lattice_options.target_points = 4000;
  lattice_options.frame = solid_frame(solid, frame);
  const Lattice lattice = make_lattice(solid, lattice_options);
  DirectionOptions direction_options;
  direction_options.frame = lattice_options.frame;
  const DirectionSet set = make_directions(solid, directions, direction_options);
  ErosionOptions options;
  options.threads = threads;
  Erosion erosion(solid, lattice, set, options);
  std::vector<std::uint32_t> list(set.size());
  std::iota(list.begin(), list.end(), 0U);
  ExecutionContext context;
  erosion.run(list, context);
  Hash hash;
  for (const Vec3& axis : lattice.grid.axes) {
    if (frame == FrameKind::kAxis) break;  // known, and not in the hashes of old
    for (int k = 0; k < 3; ++k) hash.add(axis[k]);
  }
  OptimalDirections optimal;
  std::vector<FieldValue> values;
  const double scale = solid.scale();
  for (std::uint32_t p = 0; p < lattice.points; ++p) {
    const FieldValue value = erosion.field().value(p);
    hash.add(value.erosion);
    hash.add(value.area);
    hash.add(std::uint64_t{value.direction});
    optimal.push_back(value.direction);
    values.push_back({scale * scale * scale * value.erosion, scale * scale * value.area, value.direction});
  }
  for (double h : divergence(ShockOperator::kZuckerHummel, lattice, set, optimal)) hash.add(h);
  const FrameField field = frame_field(lattice, set, values);
  std::printf("%-12s R=%u K=%zu %016" PRIx64 " %016" PRIx64 " %016" PRIx64 "\n", name, lattice.points,
              set.size(), hash.value(), chords_hash(solid, lattice, field, threads),
              ridge_hash(solid, lattice, field, threads));
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned threads = argc > 1 ? static_cast<unsigned>(std::strtoul(argv[1], nullptr, 10)) : 1;
  using namespace affskel::core;
  print_hash("torus", make_torus(6000, 2000, 256), "triangles+random:200:1", threads);
  print_hash("box", make_box(3, 2, 1, 4), "triangles+sphere:80", threads);
  print_hash("cylinder", make_cylinder(1, 2, 37), "triangles", threads);
  print_hash("hollow-ball", hollow_ball(), "triangles", threads);
  print_hash("body", make_body({292, 18000}), "triangles", threads);
  const Mesh body = make_body({292, 18000});
  print_hash("body-pca", body, "triangles", threads, FrameKind::kPca);
  print_hash("body-obb", body, "triangles", threads, FrameKind::kObb);
  print_hash("body-affine", body, "triangles+sphere:80", threads, FrameKind::kAffine);
  return 0;
}
