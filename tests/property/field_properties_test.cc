// What every field must satisfy, on random solids.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "core/test_solids.h"
#include "drawn_solids.h"

namespace affskel::property {
namespace {

using core::FieldValue;
using core::LatticeGrid;
using core::Mesh;
using core::Vec3;

// Adds up over the cases of a property how far fields differ, and prints it at the end of the program.
class Record {
 public:
  explicit Record(const char* name) : name_(name) {}
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record() {
    std::cout << name_ << ": " << cases_ << " cases, largest deviation " << of_volume_ << " v0, "
              << of_erosion_ << " E\n";
  }

  void add(const Deviation& d) {
    ++cases_;
    of_volume_ = std::max(of_volume_, d.of_volume);
    of_erosion_ = std::max(of_erosion_, d.of_erosion);
  }

 private:
  const char* name_;
  int cases_ = 0;
  double of_volume_ = 0;
  double of_erosion_ = 0;
};

double draw_part() {
  return draw_in(-1000, 1001) / 1000.0;
}

// Volumes are affinely covariant and so are the triangles' normals.
RC_GTEST_PROP(FieldProperties, UnimodularMapsLeaveEUnchanged, ()) {
  static Record record("affine map");
  const Mesh mesh = draw_solid();
  const LatticeGrid grid = draw_grid(mesh);
  const AffineMap map = draw_unimodular_map();
  const Deviation d = deviation(compute(mesh, grid), compute(map.mesh(mesh), map.grid(grid)), 1e-9, 1e-11);
  record.add(d);
  RC_ASSERT(d.of_bound <= 1);
}

// Whether direction `mine[p]` of `field` attains E at every point p, as well as the field's own.
bool attains(const Field& field, const std::vector<std::uint32_t>& mine) {
  std::map<std::uint32_t, std::vector<FieldValue>> alone;
  const double unit = std::pow(field.solid.scale(), 3);
  for (std::size_t p = 0; p < mine.size(); ++p) {
    if (mine[p] == field.value[p].direction) continue;
    const auto [at, fresh] = alone.try_emplace(mine[p]);
    if (fresh) at->second = scaled_values(field, {mine[p]});
    if (at->second[p].erosion * unit > field.value[p].erosion + 1e-11 * field.volume()) return false;
  }
  return true;
}

// How far sample point after sample point of b is from that of a, mapped, of the object's size.
double place_deviation(const Field& a, const Field& b, const AffineMap& map) {
  const core::SamplePlaces before(a.solid, a.lattice), after(b.solid, b.lattice);
  const double size = norm(b.solid.bbox_max - b.solid.bbox_min);
  double largest = 0;
  const auto& runs = a.lattice.axis[2].runs;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto& s = runs[r].start;
    if (b.lattice.axis[2].runs[r].start != s) return 1;
    largest =
        std::max(largest, norm(after.at(s[0], s[1], s[2]) - map.point(before.at(s[0], s[1], s[2]))) / size);
  }
  return largest;
}

// Unit normals go along as covectors: those of b pulled back are those of a.
double direction_deviation(const Field& a, const Field& b, const AffineMap& map) {
  double largest = 0;
  for (std::size_t i = 0; i < a.directions.size(); ++i) {
    const Vec3& n = b.directions[i];
    const Vec3 back = n.x * map.rows[0] + n.y * map.rows[1] + n.z * map.rows[2];
    largest = std::max(largest, norm((1 / norm(back)) * back - a.directions[i]));
  }
  return largest;
}

// In the affine frame the whole job goes along: lattice, directions of the sphere, field.
RC_GTEST_PROP(FieldProperties, AffineFramesMakeTheWholeJobInvariant, ()) {
  static Record record("affine frame");
  const Mesh mesh = draw_crooked_solid();
  const AffineMap map = draw_unimodular_map();
  const std::string directions = "triangles+sphere:20+random:9:" + std::to_string(draw_in(0, 1000));
  Field before = prepare_affine(mesh, directions), after = prepare_affine(map.mesh(mesh), directions);
  RC_PRE(!before.solid.self_intersecting &&
         !after.solid.self_intersecting);  // bent into itself: E is not defined
  RC_ASSERT(before.lattice.grid.dims == after.lattice.grid.dims);
  RC_ASSERT(before.lattice.points == after.lattice.points);
  RC_ASSERT(place_deviation(before, after, map) < 1e-10);
  RC_ASSERT(direction_deviation(before, after, map) < 1e-9);
  compute_values(before);
  compute_values(after);
  const Deviation d = deviation(before, after, 1e-9, 1e-11);
  record.add(d);
  RC_ASSERT(d.of_bound <= 1);
  std::vector<std::uint32_t> mine;
  for (const FieldValue& value : before.value) mine.push_back(value.direction);
  RC_ASSERT(attains(after, mine));
}

RC_GTEST_PROP(FieldProperties, ScalingMultipliesEByItsCube, ()) {
  static Record record("scaling");
  const Mesh mesh = draw_solid();
  const LatticeGrid grid = draw_grid(mesh);
  const double s = std::exp(20 * draw_part());  // 2e-9 .. 5e8
  const AffineMap map = {{Vec3{s, 0, 0}, {0, s, 0}, {0, 0, s}}, {}};
  const Deviation d =
      deviation(compute(mesh, grid), compute(map.mesh(mesh), map.grid(grid)), 1e-9, 1e-11, s * s * s);
  record.add(d);
  RC_ASSERT(d.of_bound <= 1);
}

// Coordinates keep 33 of their 53 bits: six digits of E, and next to the surface, where E has
// fewer, 2e-8 of v0.
RC_GTEST_PROP(FieldProperties, FarTranslationKeepsSixDigits, ()) {
  static Record record("translation by 1e6 sizes");
  const Mesh mesh = draw_solid();
  const LatticeGrid grid = draw_grid(mesh);
  const core::Solid solid = core::make_solid(mesh);
  const double far = 1e6 * norm(solid.bbox_max - solid.bbox_min);
  const AffineMap map = {{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                         far * Vec3{draw_part(), draw_part(), draw_part()}};
  const Deviation d = deviation(compute(mesh, grid), compute(map.mesh(mesh), map.grid(grid)), 1e-6, 2e-8);
  record.add(d);
  RC_ASSERT(d.of_bound <= 1);
}

// Another order of triangles, corners and vertices; of_triangle[i]: where old triangle i is now.
struct Shuffled {
  Mesh mesh;
  std::vector<std::uint32_t> of_triangle;
};

Shuffled draw_shuffled(const Mesh& mesh) {
  Shuffled s{mesh, draw_order(mesh.triangles.size())};
  const std::vector<std::uint32_t> of_vertex = draw_order(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) s.mesh.points[of_vertex[v]] = mesh.points[v];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const core::Triangle& t = mesh.triangles[i];
    const auto turn = draw_in<std::size_t>(0, 3);
    s.mesh.triangles[s.of_triangle[i]] = {of_vertex[t[turn]], of_vertex[t[(turn + 1) % 3]],
                                          of_vertex[t[(turn + 2) % 3]]};
  }
  return s;
}

RC_GTEST_PROP(FieldProperties, OrderOfTrianglesAndVerticesChangesIndicesOnly, ()) {
  static Record record("permutation");
  const Mesh mesh = draw_solid();
  const LatticeGrid grid = draw_grid(mesh);
  const Shuffled shuffled = draw_shuffled(mesh);
  const Field before = compute(mesh, grid), after = compute(shuffled.mesh, grid);
  const Deviation d = deviation(before, after, 1e-12, 1e-11);
  record.add(d);
  RC_ASSERT(d.of_bound <= 1);
  std::vector<std::uint32_t> mine;
  for (const FieldValue& value : before.value) mine.push_back(shuffled.of_triangle[value.direction]);
  RC_ASSERT(attains(after, mine));
}

bool same_bytes(const std::vector<FieldValue>& a, const std::vector<FieldValue>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FieldValue& x, const FieldValue& y) {
    return std::memcmp(&x.erosion, &y.erosion, sizeof x.erosion) == 0 &&
           std::memcmp(&x.area, &y.area, sizeof x.area) == 0 && x.direction == y.direction;
  });
}

RC_GTEST_PROP(FieldProperties, ReversingAllTrianglesChangesNothing, ()) {
  const Mesh mesh = draw_solid();
  const LatticeGrid grid = draw_grid(mesh);
  RC_ASSERT(same_bytes(compute(mesh, grid).value, compute(core::reversed(mesh), grid).value));
}

// Copies side by side along x, whole steps of the lattice apart: line by line its points are those of the
// first copy, then those of the second, and so on.
RC_GTEST_PROP(FieldProperties, DisjointCopiesHaveCopiesOfE, ()) {
  static Record record("copies");
  const Mesh mesh = draw_solid();
  LatticeGrid grid = draw_grid(mesh);
  const auto copies = draw_in(2U, 5U);
  Mesh many = mesh;
  LatticeGrid wide = grid;
  wide.dims[0] *= copies;
  const double step = grid.dims[0] * grid.axes[0].x;  // at least the width
  for (std::uint32_t k = 1; k < copies; ++k) many = joined(many, core::moved(mesh, {k * (step), 0, 0}));
  const Field one = compute(mesh, grid), all = compute(many, wide);
  RC_ASSERT(all.value.size() == copies * one.value.size());
  for (std::uint32_t k = 0; k < copies; ++k) {
    Field part = all;
    const auto begin = all.value.begin() + static_cast<std::ptrdiff_t>(k * one.value.size());
    part.value.assign(begin, begin + static_cast<std::ptrdiff_t>(one.value.size()));
    const Deviation d = deviation(one, part, 1e-9, 1e-11);
    record.add(d);
    RC_ASSERT(d.of_bound <= 1);
  }
}

// The merge that the service relies on: commutative, associative, idempotent.
void merge(std::vector<FieldValue>& into, const std::vector<FieldValue>& from) {
  for (std::size_t p = 0; p < into.size(); ++p) {
    if (from[p].improves(into[p])) into[p] = from[p];
  }
}

std::string draw_directions() {
  return "triangles+random:" + std::to_string(draw_in(1, 60)) + ":" + std::to_string(draw_in(0, 1000));
}

std::vector<std::uint32_t> range(std::uint32_t begin, std::uint32_t end) {
  std::vector<std::uint32_t> list(end - begin);
  std::iota(list.begin(), list.end(), begin);
  return list;
}

RC_GTEST_PROP(FieldProperties, MoreDirectionsNeverRaiseE, ()) {
  const Mesh mesh = draw_solid();
  const Field field = prepare(mesh, draw_grid(mesh), draw_directions());
  const auto count = static_cast<std::uint32_t>(field.directions.size());
  const auto few = draw_in(1U, count);
  const std::vector<FieldValue> some = scaled_values(field, range(0, few)),
                                rest = scaled_values(field, range(few, count)),
                                all = scaled_values(field, range(0, count));
  for (std::size_t p = 0; p < all.size(); ++p) {
    RC_ASSERT(all[p].erosion == std::min(some[p].erosion, rest[p].erosion));
    // On equal terms the earlier one stays.
    if (all[p].erosion == some[p].erosion) RC_ASSERT(all[p].direction == some[p].direction);
  }
}

RC_GTEST_PROP(FieldProperties, AnySplitIntoBlocksMergesToTheSameBytes, ()) {
  const Mesh mesh = draw_solid();
  const Field field = prepare(mesh, draw_grid(mesh), draw_directions());
  const std::vector<std::uint32_t> order = draw_order(field.directions.size());
  const std::vector<FieldValue> whole =
      scaled_values(field, range(0, static_cast<std::uint32_t>(order.size())));
  // Every direction goes to one block at random, and now and then to a second one.
  std::vector<std::vector<std::uint32_t>> blocks(draw_in<std::size_t>(1, 9));
  for (const std::uint32_t direction : order) {
    blocks[draw_in<std::size_t>(0, blocks.size())].push_back(direction);
    if (draw_in(0, 4) == 0) blocks[draw_in<std::size_t>(0, blocks.size())].push_back(direction);
  }
  std::vector<FieldValue> merged(whole.size());
  for (const std::uint32_t b : draw_order(blocks.size())) {
    merge(merged, scaled_values(field, blocks[b], draw_in(1U, 4U)));
    if (draw_in(0, 4) == 0) merge(merged, scaled_values(field, blocks[b]));  // reported twice
  }
  RC_ASSERT(same_bytes(merged, whole));
}

}  // namespace
}  // namespace affskel::property
