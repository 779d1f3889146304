#include "job.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>

#include "core/base/disjoint_sets.h"
#include "core/erosion/erosion.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/quality/voxel_topology.h"
#include "core/shocks/skeleton.h"
#include "wire/direction_order.h"

namespace affskel::experiments {
namespace {

using core::Vec3;

std::vector<core::FieldValue> eroded(const Job& job, unsigned threads) {
  core::ErosionOptions options;
  options.threads = threads;
  core::Erosion erosion(job.solid, job.lattice, job.directions, options);
  core::ExecutionContext context;
  erosion.run(wire::directions_in_order(job.directions.size()), context);
  const double area_unit = std::ldexp(1.0, 2 * job.solid.exponent);
  const double volume_unit = std::ldexp(1.0, 3 * job.solid.exponent);
  std::vector<core::FieldValue> values(job.lattice.points);
  for (std::uint32_t p = 0; p < job.lattice.points; ++p) {
    values[p] = erosion.field().value(p);
    values[p].erosion *= volume_unit;
    values[p].area *= area_unit;
  }
  return values;
}

Cloud cloud_of(const Job& job, std::vector<std::uint32_t> rank) {
  Cloud cloud;
  cloud.rank = std::move(rank);
  const core::SamplePlaces places(job.solid, job.lattice);
  for (const core::LatticePlace& place : core::lattice_places(job.lattice, cloud.rank)) {
    cloud.place.push_back(places.at(place[0], place[1], place[2]));
  }
  for (const std::uint32_t point : cloud.rank) cloud.erosion.push_back(job.values[point].erosion);
  return cloud;
}

// The 13 of the 26 neighbours that come before a place in lattice order.
std::vector<std::array<int, 3>> earlier_neighbours() {
  std::vector<std::array<int, 3>> steps;
  for (int i = -1; i <= 0; ++i) {
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        if (std::array{i, j, k} < std::array{0, 0, 0}) steps.push_back({i, j, k});
      }
    }
  }
  return steps;
}

}  // namespace

double Job::highest_share() const {
  double highest = 0;
  for (const core::FieldValue& value : values) highest = std::max(highest, value.erosion);
  return highest / solid.volume;
}

Job compute(const core::Mesh& mesh, const JobOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Job job;
  job.mesh = mesh;
  job.solid = core::make_solid(mesh);
  const core::Matrix3 frame = core::solid_frame(job.solid, options.frame);
  core::LatticeOptions lattice;
  lattice.spacing = options.spacing;
  lattice.frame = frame;
  job.lattice = core::make_lattice(job.solid, lattice);
  core::DirectionOptions directions;
  directions.frame = frame;
  job.directions = core::make_directions(job.solid, options.directions, directions);
  job.values = eroded(job, options.threads);
  job.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return job;
}

Cloud thresholded(const Job& job, std::span<const double> divergence, double threshold) {
  std::vector<std::uint32_t> rank;
  for (const core::SkeletonPoint& point :
       core::skeleton_points({divergence.begin(), divergence.end()}, threshold)) {
    rank.push_back(point.point);
  }
  return cloud_of(job, std::move(rank));
}

std::vector<double> divergence_of(const Job& job, core::ShockOperator shock_operator) {
  core::OptimalDirections optimal;
  optimal.reserve(job.values.size());
  for (const core::FieldValue& value : job.values) optimal.push_back(value.direction);
  return core::divergence(shock_operator, job.lattice, core::frame_directions(job.lattice, job.directions),
                          optimal);
}

Cloud zucker_hummel_skeleton(const Job& job) {
  const auto shock_operator = core::ShockOperator::kZuckerHummel;
  return thresholded(job, divergence_of(job, shock_operator),
                     core::default_threshold(shock_operator, job.lattice.spacing));
}

Cloud all_points(const Job& job) {
  std::vector<std::uint32_t> rank(job.lattice.points);
  for (std::uint32_t p = 0; p < job.lattice.points; ++p) rank[p] = p;
  return cloud_of(job, std::move(rank));
}

core::BettiNumbers topology(const Job& job, const Cloud& cloud) {
  return core::voxel_betti_numbers(core::lattice_places(job.lattice, cloud.rank));
}

std::vector<std::size_t> piece_sizes(const Job& job, const Cloud& cloud) {
  const std::vector<core::LatticePlace> places = core::lattice_places(job.lattice, cloud.rank);
  const auto steps = earlier_neighbours();
  core::DisjointSets sets(places.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (const std::array<int, 3>& step : steps) {
      core::LatticePlace neighbour = places[p];
      // Below 0 it wraps round to a place that no lattice has.
      for (std::size_t a = 0; a < 3; ++a) neighbour[a] += static_cast<std::uint32_t>(step[a]);
      const auto found = std::lower_bound(places.begin(), places.end(), neighbour);
      if (found == places.end() || *found != neighbour) continue;
      sets.unite(static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(found - places.begin()));
    }
  }
  std::vector<std::size_t> sizes(places.size());
  for (std::size_t p = 0; p < places.size(); ++p) ++sizes[sets.find(static_cast<std::uint32_t>(p))];
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  sizes.erase(std::find(sizes.begin(), sizes.end(), 0U), sizes.end());
  return sizes;
}

}  // namespace affskel::experiments
