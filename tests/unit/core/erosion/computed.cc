#include "core/erosion/computed.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

#include "core/erosion/directions.h"

namespace affskel::core {

Lattice lattice_of(const Solid& solid, double spacing) {
  LatticeOptions options;
  options.spacing = spacing;
  return make_lattice(solid, options);
}

namespace {

Lattice lattice_through_the_middle(const Solid& solid, double spacing) {
  LatticeGrid grid = lattice_of(solid, spacing).grid;
  for (std::size_t k = 0; k < 3; ++k) {
    grid.origin = grid.origin - 0.5 * grid.axes[k];
    ++grid.dims[k];
  }
  return make_lattice(solid, grid);
}

}  // namespace

Computed compute(Solid solid, Lattice lattice, const std::string& directions, const How& how) {
  Computed result{std::move(solid), std::move(lattice), {}, {}, {}, {}};
  result.directions = make_directions(result.solid, directions);
  Erosion erosion(result.solid, result.lattice, result.directions, {how.threads, false, how.prune});
  std::vector<std::uint32_t> list(result.directions.size());
  std::iota(list.begin(), list.end(), 0U);
  if (how.shuffle != 0) std::shuffle(list.begin(), list.end(), std::mt19937_64(how.shuffle));
  ExecutionContext context;
  erosion.run(list, context);
  result.counts = erosion.cost().counts;
  const SamplePlaces places(result.solid, result.lattice);
  const double unit = result.solid.scale();
  for (const LatticeRun& run : result.lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      FieldValue value = erosion.field().value(run.first + n);
      value.erosion *= unit * unit * unit;
      value.area *= unit * unit;
      result.value.push_back(value);
      result.place.push_back(places.at(run.start[0], run.start[1], run.start[2] + n));
    }
  }
  return result;
}

Computed compute(const Mesh& mesh, double spacing, const std::string& directions, const How& how) {
  Solid solid = make_solid(mesh);
  Lattice lattice = lattice_of(solid, spacing);
  return compute(std::move(solid), std::move(lattice), directions, how);
}

Computed compute_through_the_middle(const Mesh& mesh, double spacing, const std::string& directions) {
  Solid solid = make_solid(mesh);
  Lattice lattice = lattice_through_the_middle(solid, spacing);
  return compute(std::move(solid), std::move(lattice), directions);
}

bool same_bytes(const Computed& a, const Computed& b) {
  if (a.value.size() != b.value.size()) return false;
  for (std::size_t i = 0; i < a.value.size(); ++i) {
    if (std::memcmp(&a.value[i].erosion, &b.value[i].erosion, 8) != 0) return false;
    if (std::memcmp(&a.value[i].area, &b.value[i].area, 8) != 0) return false;
    if (a.value[i].direction != b.value[i].direction) return false;
  }
  return true;
}

}  // namespace affskel::core
