#include "drawn_solids.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid_frame.h"
#include "core/test_solids.h"

namespace affskel::property {
namespace {

using core::FieldValue;
using core::LatticeGrid;
using core::Mesh;
using core::Vec3;

// A number of three decimals in [low, high].
double draw(double low, double high) {
  const int thousandths = draw_in(0, 1001);
  return low + (high - low) * thousandths / 1000;
}

std::uint32_t draw_count(std::uint32_t low, std::uint32_t high) {
  return draw_in(low, high + 1);
}

Mesh draw_torus() {
  const double minor = draw(0.3, 1), major = minor * draw(1.3, 4);
  return core::make_torus(major, minor, 2 * draw_count(4, 9) * draw_count(4, 7));
}

Mesh draw_hollow_ball() {
  const double inner = draw(0.5, 1.5);
  const Vec3 offset = {draw(-0.5, 0.5), draw(-0.5, 0.5), draw(-0.5, 0.5)};
  return joined(core::make_sphere(3, 80), core::reversed(core::moved(core::make_sphere(inner, 20), offset)));
}

// Meshing a body takes a second, so there is one, stretched.
Mesh draw_body() {
  static const Mesh body = core::make_body({200, 1.8});
  Mesh mesh = body;
  const double x = draw(0.7, 1.4), y = draw(0.7, 1.4);
  for (Vec3& p : mesh.points) p = {x * p.x, y * p.y, p.z};
  return mesh;
}

}  // namespace

Mesh draw_solid() {
  switch (draw_in(0, 8)) {
    case 0:
      return core::make_box(draw(0.5, 3), draw(0.5, 3), draw(0.5, 3), draw_count(1, 3));
    case 1:
      return core::make_ellipsoid(draw(0.5, 3), draw(0.5, 3), draw(0.5, 3), 20 * draw_count(1, 4));
    case 2:
      return core::make_cone(draw(0.5, 3), draw(0.5, 3), draw_count(3, 24));
    case 3:
      return draw_torus();
    case 4:
      return draw_hollow_ball();
    case 5:
      return core::cup(draw_count(5, 16));
    case 6:
      return core::comb(draw_count(2, 4));
    default:
      return draw_body();
  }
}

Mesh draw_crooked_solid() {
  Mesh mesh = draw_solid();
  const core::Solid solid = core::make_solid(mesh);
  const Vec3 middle = 0.5 * (solid.bbox_min + solid.bbox_max), side = solid.bbox_max - solid.bbox_min;
  const double a = draw(0.3, 0.6), b = draw(0.3, 0.6), c = draw(0.3, 0.6), d = draw(0.1, 0.3);
  for (Vec3& p : mesh.points) {
    // Each coordinate moves by a function of those before it: a bijection of space, and nothing is folded.
    const double x = (p.x - middle.x) / side.x, y = (p.y - middle.y) / side.y + a * x * x + d * x * x * x,
                 z = (p.z - middle.z) / side.z + b * y * y + c * x * y - d * x * x * y;
    p = {side.x * (x + a * z * z), side.y * y, side.z * z};
  }
  return mesh;
}

LatticeGrid draw_grid(const Mesh& mesh, double points) {
  const core::Solid solid = core::make_solid(mesh);
  const double spacing = std::cbrt(solid.volume / points);
  const Vec3 side = solid.bbox_max - solid.bbox_min;
  LatticeGrid grid;
  grid.origin = solid.bbox_min + spacing * Vec3{draw(0.05, 0.95), draw(0.05, 0.95), draw(0.05, 0.95)};
  grid.axes = {Vec3{spacing, 0, 0}, {0, spacing, 0}, {0, 0, spacing}};
  for (int k = 0; k < 3; ++k)
    grid.dims[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(std::ceil(side[k] / spacing));
  return grid;
}

std::vector<std::uint32_t> draw_order(std::size_t count) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[draw_in<std::size_t>(0, i)]);
  return order;
}

Mesh AffineMap::mesh(Mesh m) const {
  for (Vec3& p : m.points) p = point(p);
  return m;
}

LatticeGrid AffineMap::grid(const LatticeGrid& f) const {
  return {point(f.origin), {vector(f.axes[0]), vector(f.axes[1]), vector(f.axes[2])}, f.dims};
}

AffineMap draw_unimodular_map() {
  // A lower times an upper triangular matrix with ones, its rows scaled by factors of product 1.
  const double a = draw(-1, 1), b = draw(-1, 1), c = draw(-1, 1), p = draw(-1, 1), q = draw(-1, 1),
               r = draw(-1, 1);
  const double s = draw(0.71, 1.41), t = draw(0.71, 1.41);
  return {{s * Vec3{1, p, q}, t * Vec3{a, 1 + a * p, a * q + r},
           (1 / (s * t)) * Vec3{b, b * p + c, b * q + c * r + 1}},
          {draw(-3, 3), draw(-3, 3), draw(-3, 3)}};
}

Field prepare(const Mesh& mesh, const LatticeGrid& grid, const std::string& directions) {
  Field field{core::make_solid(mesh), {}, {}, {}};
  const double unit = 1 / field.solid.scale();
  field.lattice =
      core::make_lattice(field.solid, {unit * (grid.origin - field.solid.centre),
                                       {unit * grid.axes[0], unit * grid.axes[1], unit * grid.axes[2]},
                                       grid.dims});
  field.directions = core::make_directions(field.solid, directions);
  return field;
}

std::vector<FieldValue> scaled_values(const Field& field, const std::vector<std::uint32_t>& list,
                                      unsigned threads) {
  core::Erosion erosion(field.solid, field.lattice, field.directions, {threads, false, true});
  core::ExecutionContext context;
  erosion.run(list, context);
  std::vector<FieldValue> values;
  for (std::uint32_t p = 0; p < field.lattice.points; ++p) values.push_back(erosion.field().value(p));
  return values;
}

Field prepare_affine(const Mesh& mesh, const std::string& directions, std::uint64_t points) {
  Field field{core::make_solid(mesh), {}, {}, {}};
  core::LatticeOptions lattice;
  lattice.target_points = points;
  lattice.frame = core::solid_frame(field.solid, core::FrameKind::kAffine);
  field.lattice = core::make_lattice(field.solid, lattice);
  core::DirectionOptions options;
  options.frame = lattice.frame;
  field.directions = core::make_directions(field.solid, directions, options);
  return field;
}

void compute_values(Field& field) {
  std::vector<std::uint32_t> all(field.directions.size());
  std::iota(all.begin(), all.end(), 0U);
  field.value = scaled_values(field, all);
  const double unit = field.solid.scale();
  for (FieldValue& value : field.value) {
    value.erosion *= unit * unit * unit;
    value.area *= unit * unit;
  }
}

Field compute(const Mesh& mesh, const LatticeGrid& grid, const std::string& directions) {
  Field field = prepare(mesh, grid, directions);
  compute_values(field);
  return field;
}

Deviation deviation(const Field& a, const Field& b, double relative, double absolute, double factor) {
  if (a.value.size() != b.value.size()) throw std::invalid_argument("fields of different numbers of points");
  Deviation largest;
  for (std::size_t p = 0; p < a.value.size(); ++p) {
    const double e = a.value[p].erosion, off = std::abs(e - b.value[p].erosion / factor);
    largest.of_volume = std::max(largest.of_volume, off / a.volume());
    largest.of_erosion = std::max(largest.of_erosion, off / e);
    largest.of_bound = std::max(largest.of_bound, off / (relative * e + absolute * a.volume()));
  }
  return largest;
}

}  // namespace affskel::property
