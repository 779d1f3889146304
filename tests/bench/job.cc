#include "job.h"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "base/read_file.h"
#include "clocks.h"
#include "core/base/execution_context.h"
#include "core/text/off_file.h"
#include "wire/direction_order.h"

namespace affskel::bench {
namespace {

constexpr std::size_t kMaxBatches = 256;

core::Solid read_solid(const std::string& path, unsigned threads) {
  const core::OffMesh off = core::read_off(base::read_file(path));
  return core::make_solid(off.mesh, {true, true, threads}, off.vertex_line, off.triangle_line);
}

core::Lattice lattice_of(const core::Solid& solid, const RowSpec& row, unsigned threads) {
  core::LatticeOptions options;
  options.threads = threads;
  options.target_points = row.points;
  options.spacing = row.spacing;
  if (row.mesh.shape == Shape::kBody) {
    const core::Vec3 size = solid.bbox_max - solid.bbox_min;
    options.spacing *= std::max({size.x, size.y, size.z}) / kBodyUnits;
  }
  return core::make_lattice(solid, options);
}

std::vector<std::uint32_t> work_order(std::size_t count, std::uint64_t at_most) {
  std::vector<std::uint32_t> list = wire::directions_in_order(count);
  if (at_most > 0 && at_most < count) list.resize(at_most);
  return list;
}

}  // namespace

Job::Job(const std::string& off_file, const RowSpec& row, unsigned threads, bool prune)
    : started_(wall_now()),
      solid_(read_solid(off_file, threads)),
      lattice_(lattice_of(solid_, row, threads)),
      directions_(core::make_directions(solid_, row.directions)),
      list_(work_order(directions_.size(), row.max_directions)) {
  core::ErosionOptions options;
  options.threads = threads;
  options.prune = prune;
  erosion_ = std::make_unique<core::Erosion>(solid_, lattice_, directions_, options);
  cost_.prepare_s = wall_now() - started_;
  cost_.wall_s = cost_.prepare_s;
}

void Job::run(std::size_t begin, std::size_t end) {
  core::ExecutionContext context;
  const double wall = wall_now(), cpu = process_cpu_now();
  erosion_->run(std::span(list_).subspan(begin, end - begin), context);
  cost_.wall_s += wall_now() - wall;
  cost_.cpu_s += process_cpu_now() - cpu;
  const core::ErosionCost cost = erosion_->cost();
  cost_.trees_s = cost.trees_s;
  cost_.sweep_s = cost.sweep_s;
  cost_.counts = cost.counts;
}

std::vector<Batch> Job::run_in_batches(std::size_t begin, std::size_t end) {
  const std::size_t step = (end - begin + kMaxBatches - 1) / kMaxBatches;
  std::vector<Batch> batches;
  for (std::size_t at = begin; at < end; at += step) {
    const JobCost before = cost_;
    run(at, std::min(at + step, end));
    batches.push_back({cost_.trees_s - before.trees_s, cost_.sweep_s - before.sweep_s,
                       cost_.wall_s - before.wall_s, cost_.cpu_s - before.cpu_s});
  }
  return batches;
}

void keep_fastest(std::vector<Batch>& best, const std::vector<Batch>& now) {
  if (best.empty()) best = now;
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (now.at(i).wall_s < best[i].wall_s) best[i] = now[i];
  }
}

double trees_cpu(const std::vector<Batch>& batches) {
  double sum = 0;
  for (const Batch& b : batches) sum += b.cpu_of(b.trees_s);
  return sum;
}

double sweep_cpu(const std::vector<Batch>& batches) {
  double sum = 0;
  for (const Batch& b : batches) sum += b.cpu_of(b.sweep_s);
  return sum;
}

}  // namespace affskel::bench
