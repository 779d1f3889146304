#include "fields.h"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/infimum/refine.h"

namespace affskel::experiments {

Grid grid_round(const core::Mesh& mesh, double spacing) {
  const Job job = compute(mesh, {spacing, "sphere:20"});
  Grid grid{job.lattice.grid, spacing};
  grid.grid.origin = job.solid.centre + job.solid.scale() * grid.grid.origin;
  for (core::Vec3& axis : grid.grid.axes) axis = job.solid.scale() * axis;
  return grid;
}

Fields::Fields(const core::Mesh& mesh, const Grid& grid, const std::string& directions, unsigned threads)
    : threads_(threads) {
  job_.mesh = mesh;
  job_.solid = core::make_solid(mesh);
  core::LatticeGrid scaled = grid.grid;
  const double unit = job_.solid.scale();
  scaled.origin = (1 / unit) * (scaled.origin - job_.solid.centre);
  for (core::Vec3& axis : scaled.axes) axis = (1 / unit) * axis;
  job_.lattice = core::make_lattice(job_.solid, scaled, threads);
  job_.lattice.spacing = grid.spacing;
  job_.directions = core::make_directions(job_.solid, directions);
  erode();
}

void Fields::go_on() {
  core::ExecutionContext context;
  const core::PieceInput input(job_.solid, threads_);
  const std::vector<core::LeastChord> least =
      core::refine(input, job_.lattice, job_.directions, erosion_->field(), threads_, context);
  job_.directions.clear();
  job_.over_set = false;
  for (std::uint32_t p = 0; p < least.size(); ++p) {
    job_.directions.push_back(least[p].normal);
    job_.saddles.push_back(least[p].saddles);
    put(p, {least[p].erosion, least[p].slope, p});
  }
}

Values Fields::erosion() const {
  std::vector<std::uint32_t> all(job_.lattice.points);
  std::iota(all.begin(), all.end(), 0U);
  const std::vector<core::LatticePlace> places = core::lattice_places(job_.lattice, all);
  Values values;
  for (const std::uint32_t p : all) values[places[p]] = job_.values[p].erosion;
  return values;
}

void Fields::erode() {
  erosion_.emplace(job_.solid, job_.lattice, job_.directions, core::ErosionOptions{.threads = threads_});
  std::vector<std::uint32_t> list(job_.directions.size());
  std::iota(list.begin(), list.end(), 0U);
  core::ExecutionContext context;
  erosion_->run(list, context);
  job_.values.resize(job_.lattice.points);
  for (std::uint32_t p = 0; p < job_.lattice.points; ++p) put(p, erosion_->field().value(p));
}

void Fields::put(std::uint32_t p, core::FieldValue value) {
  value.erosion *= std::ldexp(1.0, 3 * job_.solid.exponent);
  value.area *= std::ldexp(1.0, 2 * job_.solid.exponent);
  job_.values[p] = value;
}

}  // namespace affskel::experiments
