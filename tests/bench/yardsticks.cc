#include "yardsticks.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "clocks.h"
#include "job.h"

namespace affskel::bench {
namespace {

using Pair = std::pair<double, std::uint32_t>;

// Pairs to sort and chords to compute in one repeat: a few tenths of a second.
constexpr std::uint64_t kSortPairs = 1500000;
constexpr std::uint64_t kPlainChords = 30000000;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The directions whose pairs are sorted between two looks at the clock, which is slow next to a small sort.
constexpr std::size_t kBatchPairs = 4096;

void fill(const core::Mesh& mesh, const core::Vec3& d, std::vector<Pair>& pairs) {
  for (std::size_t v = 0; v < pairs.size(); ++v) {
    pairs[v] = {core::dot(d, mesh.points[v]), static_cast<std::uint32_t>(v)};
  }
}

double time_batch(const core::Mesh& mesh, const core::DirectionSet& directions,
                  std::span<const std::uint32_t> batch, std::vector<std::vector<Pair>>& pairs) {
  for (std::size_t i = 0; i < batch.size(); ++i) fill(mesh, directions[batch[i]], pairs[i]);
  const double start = thread_cpu_now();
  for (std::size_t i = 0; i < batch.size(); ++i) std::sort(pairs[i].begin(), pairs[i].end());
  return thread_cpu_now() - start;
}

}  // namespace

Yardstick sort_unit(const core::Mesh& mesh, const core::DirectionSet& directions,
                    std::span<const std::uint32_t> list, int repeats) {
  const std::size_t size = std::min(mesh.points.size(), mesh.triangles.size() / 2);
  const std::size_t sample = std::min(list.size(), std::max<std::size_t>(16, kSortPairs / size));
  const std::size_t per_batch = std::clamp<std::size_t>(kBatchPairs / size, 1, sample);
  std::vector<std::vector<Pair>> pairs(per_batch, std::vector<Pair>(size));
  std::vector<double> best((sample + per_batch - 1) / per_batch, kInfinity);
  // All batches before any is repeated: branch prediction learns a small sort by heart.
  for (int i = 0; i < repeats; ++i) {
    for (std::size_t b = 0; b < best.size(); ++b) {
      const std::size_t begin = b * per_batch;
      const auto batch = list.subspan(begin, std::min(per_batch, sample - begin));
      best[b] = std::min(best[b], time_batch(mesh, directions, batch, pairs));
    }
  }
  const double total = std::accumulate(best.begin(), best.end(), 0.0);
  return {total / static_cast<double>(sample), sample};
}

Yardstick plain_sweep(const std::string& off_file, const RowSpec& row, int repeats) {
  Job job(off_file, row, 1, false);
  const std::size_t count = job.list().size();
  const std::size_t before = std::min<std::size_t>(count / 2, 64);
  const std::size_t wanted = std::max<std::size_t>(8, kPlainChords / job.lattice().points);
  const std::size_t sample = std::min(count - before, wanted);
  job.run(0, before);
  std::vector<Batch> best;
  for (int i = 0; i < repeats; ++i) keep_fastest(best, job.run_in_batches(before, before + sample));
  return {sweep_cpu(best) / static_cast<double>(sample), sample};
}

}  // namespace affskel::bench
