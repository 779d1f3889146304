#include "measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>

#include "forked.h"
#include "job.h"
#include "reference_time.h"
#include "yardsticks.h"

namespace affskel::bench {
namespace {

// Short jobs are repeated until they have taken this long together, or so often.
constexpr double kRepeatSeconds = 2;
constexpr int kMaxRepeats = 20;
constexpr int kYardstickRepeats = 3;
constexpr int kTwoThreadRepeats = 3;
constexpr double kTwoThreadSeconds = 60;

// Processor seconds per second that two threads get when no other process wants the processors.
constexpr double kTwoProcessors = 1.96;

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void describe(const Job& job, RowResult& result) {
  result.triangles = job.solid().mesh.triangles.size();
  result.points = job.lattice().points;
  result.directions = job.list().size();
  result.directions_all = job.directions().size();
  result.spacing = job.lattice().spacing;
  result.v0 = job.solid().volume;
}

void take(const JobCost& cost, RowResult& result) {
  result.prepare_s = cost.prepare_s;
  result.trees_s = cost.trees_s;
  result.sweep_s = cost.sweep_s;
  result.wall_s = cost.wall_s;
  result.chords_evaluated = cost.counts.evaluated;
  result.chords_tested = cost.counts.tested;
}

void run_job(const RowSpec& row, const std::string& off_file, RowResult& result) {
  JobCost best;
  std::vector<Batch> batches;
  double spent = 0;
  for (result.repeats = 0; result.repeats < kMaxRepeats && spent < kRepeatSeconds; ++result.repeats) {
    Job job(off_file, row, 1);
    keep_fastest(batches, job.run_in_batches(0, job.list().size()));
    spent += job.cost().wall_s;
    if (result.repeats == 0) {
      result.peak_mb = peak_mb();
      describe(job, result);
    }
    if (result.repeats == 0 || job.cost().wall_s < best.wall_s) best = job.cost();
  }
  take(best, result);
  result.trees_cpu_s = trees_cpu(batches);
  result.sweep_cpu_s = sweep_cpu(batches);
}

void run_yardsticks(const RowSpec& row, const std::string& off_file, RowResult& result) {
  {
    const Job job(off_file, row, 1);
    const Yardstick sort = sort_unit(job.solid().mesh, job.directions(), job.list(), kYardstickRepeats);
    result.sort_unit_s = sort.seconds_per_direction;
    result.sort_directions = sort.directions;
  }
  const Yardstick plain = plain_sweep(off_file, row, kYardstickRepeats);
  result.plain_ns = 1e9 * plain.seconds_per_direction / static_cast<double>(result.points);
  result.plain_directions = plain.directions;
}

// The best of several runs, the first that had two processors to itself being the last.
double two_threads_s(const RowSpec& row, const std::string& off_file) {
  double best = std::numeric_limits<double>::infinity();
  double spent = 0;
  for (int i = 0; i < kTwoThreadRepeats && spent < kTwoThreadSeconds; ++i) {
    Job job(off_file, row, 2);
    const double prepare_s = job.cost().wall_s;
    job.run();
    best = std::min(best, job.cost().wall_s);
    spent += job.cost().wall_s;
    if (job.cost().cpu_s >= kTwoProcessors * (job.cost().wall_s - prepare_s)) break;
  }
  return best;
}

RowResult measure_here(const RowSpec& row, const std::string& off_file, const MeasureOptions& options) {
  RowResult result;
  run_job(row, off_file, result);
  if (row.section == Section::kTable) run_yardsticks(row, off_file, result);
  if (options.two_threads && result.wall_s >= kLongJob) {
    result.wall_two_threads_s = two_threads_s(row, off_file);
  }
  if (options.reference_s > 0) result.reference = run_reference(row, off_file, options.reference_s);
  return result;
}

template <class T>
void keep_less(std::optional<T>& mine, const std::optional<T>& other) {
  if (other && (!mine || *other < *mine)) mine = other;
}

}  // namespace

RowResult measure(const RowSpec& row, const std::string& off_file, const MeasureOptions& options) {
  RowResult result;
  try {
    const std::string text = run_forked(
        [&] { return nlohmann::json(measure_here(row, off_file, options)).dump(); }, options.memory_limit);
    result = nlohmann::json::parse(text).get<RowResult>();
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  result.name = row_name(row);
  result.section = row.section;
  return result;
}

RowResult better_of(const RowResult& a, const RowResult& b) {
  if (!a.error.empty()) return b;
  if (!b.error.empty()) return a;
  RowResult best = a.wall_s <= b.wall_s ? a : b;
  const RowResult& other = a.wall_s <= b.wall_s ? b : a;
  best.trees_cpu_s = std::min(a.trees_cpu_s, b.trees_cpu_s);
  best.sweep_cpu_s = std::min(a.sweep_cpu_s, b.sweep_cpu_s);
  keep_less(best.sort_unit_s, other.sort_unit_s);
  keep_less(best.plain_ns, other.plain_ns);
  if (!best.reference) best.reference = other.reference;
  return best;
}

}  // namespace affskel::bench
