#include "core/erosion/erosion.h"

#include <atomic>
#include <vector>

#include "base/mutex.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/erosion/join_tree.h"

namespace affskel::core {
class Erosion::Engine {
 public:
  Engine(const Solid& solid, const Lattice& lattice, const DirectionSet& directions,
         const ErosionOptions& options)
      : directions_(directions),
        trees_(solid, options.threads),
        field_(lattice.points, options.track_changes),
        sweeper_(lattice, field_,
                 {options.prune, 2 * trees_.volume_tolerance(), solid.scaled(solid.volume)}) {
    const JoinTreeOptions tree_options{solid.self_intersecting};
    builders_.resize(std::max(1U, options.threads));
    parallel_for(options.threads, builders_.size(), [&](std::size_t i) {
      builders_[i] = std::make_unique<JoinTreeBuilder>(trees_, tree_options);
    });
  }

  void run(std::span<const std::uint32_t> list, ExecutionContext& context) {
    std::atomic<std::uint64_t> next{0};
    std::atomic<bool> failed{false};
    parallel_for(static_cast<unsigned>(builders_.size()), builders_.size(), [&](std::size_t i) {
      try {
        work_off(*builders_[i], list, next, failed, context);
      } catch (...) {
        failed = true;
        throw;
      }
    });
  }

  ErosionField& field() { return field_; }

  ErosionCost cost() const {
    const base::MutexLock guard(mutex_);
    return cost_;
  }

 private:
  void work_off(JoinTreeBuilder& builder, std::span<const std::uint32_t> list,
                std::atomic<std::uint64_t>& next, const std::atomic<bool>& failed,
                ExecutionContext& context) {
    ErosionCost spent;
    Stopwatch watch;
    while (!failed && !context.stop_requested()) {
      const std::uint64_t item = next++;
      if (item >= list.size()) break;
      const Vec3& d = directions_[list[item]];
      if (d != Vec3{}) {
        watch.lap();
        const JoinTree& tree = builder.build(d);
        spent.trees_s += watch.lap();
        spent.counts += sweeper_.sweep(tree, d, list[item]);
        spent.sweep_s += watch.lap();
      }
      context.item_done(item);
    }
    const base::MutexLock guard(mutex_);
    cost_.trees_s += spent.trees_s;
    cost_.sweep_s += spent.sweep_s;
    cost_.counts += spent.counts;
  }

  const DirectionSet& directions_;
  TreeInput trees_;
  ErosionField field_;
  Sweeper sweeper_;
  std::vector<std::unique_ptr<JoinTreeBuilder>> builders_;
  mutable base::Mutex mutex_;
  ErosionCost cost_ ABSL_GUARDED_BY(mutex_);
};

Erosion::Erosion(const Solid& solid, const Lattice& lattice, const DirectionSet& directions,
                 const ErosionOptions& options)
    : engine_(std::make_unique<Engine>(solid, lattice, directions, options)) {}
Erosion::~Erosion() = default;

void Erosion::run(std::span<const std::uint32_t> list, ExecutionContext& context) {
  engine_->run(list, context);
}
ErosionField& Erosion::field() {
  return engine_->field();
}
ErosionCost Erosion::cost() const {
  return engine_->cost();
}

}  // namespace affskel::core
