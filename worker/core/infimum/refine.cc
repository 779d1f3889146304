#include "core/infimum/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/lattice_edges.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kNobody = FieldValue::kNoDirection;
constexpr std::size_t kBlock = 64;  // points that a thread takes at once

// When a neighbour's plane is worth a descent, by the volume E + |grad E| n.(x - y) that it promises at x.
constexpr double kPromised = 1.2;    // at most so many times what is known
constexpr double kFirst = 3;         // the piece that the descent begins with, likewise
constexpr double kAlike = 0.98;      // cosine between planes of one basin
constexpr double kNoBetter = 0.999;  // alike planes that promise no less than this are of one basin
constexpr double kLess = 1e-10;      // by which a piece must be less to take the place of another

class Refinement {
 public:
  Refinement(const PieceInput& input, const Lattice& lattice, unsigned threads, ExecutionContext& context)
      : input_(input), lattice_(lattice), threads_(threads), context_(context) {
    std::vector<std::uint32_t> all(lattice.points);
    std::iota(all.begin(), all.end(), 0U);
    places_ = lattice_places(lattice, all);
    around_.resize(lattice.points);
    for (auto& around : around_) around.fill(kNobody);
    for_each_edge(lattice, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto&) {
      around_[x][2 * axis] = y;
      around_[y][2 * axis + 1] = x;
    });
  }

  std::vector<LeastChord> take() { return std::move(least_); }
  std::uint64_t evaluations() const {
    std::uint64_t sum = 0;
    for (const auto& descent : idle_) sum += descent->evaluations();
    return sum;
  }

  void begin(const DirectionSet& directions, const ErosionField& seeds) {
    least_.resize(lattice_.points);
    changed_.assign(lattice_.points, 1);
    todo_.resize(lattice_.points);
    std::iota(todo_.begin(), todo_.end(), 0U);
    each_point([&](std::size_t i, ChordDescent& descent) {
      const std::uint32_t p = todo_[i];
      const FieldValue seed = seeds.value(p);
      LeastChord start;
      start.normal = directions[seed.direction];
      start.erosion = seed.erosion;
      start.area = start.slope = seed.area;
      LeastChord& least = least_[p];
      least = descent.descend(at(p), start);
      if (!(least.erosion <= start.erosion * (1 + kSeedRounding))) least = start;
    });
  }

  // One round; false when nothing changed.
  bool propagate() {
    find_todo();
    next_.resize(todo_.size());
    each_point([&](std::size_t i, ChordDescent& descent) { next_[i] = least_of_offers(todo_[i], descent); });
    std::fill(changed_.begin(), changed_.end(), 0);
    bool any = false;
    for (std::size_t i = 0; i < todo_.size(); ++i) {
      if (!(next_[i].erosion < least_[todo_[i]].erosion)) continue;
      least_[todo_[i]] = next_[i];
      changed_[todo_[i]] = 1;
      any = true;
    }
    return any;
  }

 private:
  static constexpr double kSeedRounding = 1e-9;  // seeds have 36 bits

  Vec3 at(std::uint32_t p) const {
    const auto& [i, j, k] = places_[p];
    return grid_place(lattice_.grid, i, j, k);
  }

  // Calls body(i, descent) for the points todo_[i].
  template <class Body>
  void each_point(const Body& body) {
    parallel_for(threads_, (todo_.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
      throw_if_stopped(&context_);
      std::unique_ptr<ChordDescent> descent = borrow();
      const std::size_t end = std::min(todo_.size(), (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < end; ++i) body(i, *descent);
      give_back(std::move(descent));
    });
  }

  std::unique_ptr<ChordDescent> borrow() {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (idle_.empty()) return std::make_unique<ChordDescent>(input_);
    std::unique_ptr<ChordDescent> descent = std::move(idle_.back());
    idle_.pop_back();
    return descent;
  }
  void give_back(std::unique_ptr<ChordDescent> descent) {
    const std::lock_guard<std::mutex> guard(mutex_);
    idle_.push_back(std::move(descent));
  }

  void find_todo() {
    todo_.clear();
    for (std::uint32_t p = 0; p < lattice_.points; ++p) {
      const bool offered = std::any_of(around_[p].begin(), around_[p].end(),
                                       [&](std::uint32_t q) { return q != kNobody && changed_[q] != 0; });
      if (offered) todo_.push_back(p);
    }
  }

  LeastChord least_of_offers(std::uint32_t p, ChordDescent& descent) const {
    const Vec3 x = at(p);
    LeastChord best = least_[p];
    std::array<const LeastChord*, 7> tried{&least_[p]};
    std::size_t tries = 1;
    for (const std::uint32_t q : around_[p]) {
      if (q == kNobody || changed_[q] == 0) continue;
      const LeastChord& offer = least_[q];
      const double promise = offer.erosion + offer.slope * dot(offer.normal, x - at(q));
      const bool less = promise < kNoBetter * best.erosion;
      const bool known = std::any_of(tried.begin(), tried.begin() + tries, [&](const LeastChord* other) {
        return (!less || other->saddles == offer.saddles) && dot(other->normal, offer.normal) > kAlike;
      });
      if (known || promise > kPromised * best.erosion) continue;
      tried[tries++] = &offer;
      const LeastChord found = descent.descend(x, offer, {kFirst * best.erosion, best.erosion});
      if (found.erosion < best.erosion * (1 - kLess)) best = found;
    }
    return best;
  }

  const PieceInput& input_;
  const Lattice& lattice_;
  unsigned threads_;
  ExecutionContext& context_;
  std::vector<LatticePlace> places_;
  std::vector<std::array<std::uint32_t, 6>> around_;  // neighbours within the solid; kNobody
  std::vector<LeastChord> least_;
  std::vector<std::uint8_t> changed_;  // in the last round
  std::vector<std::uint32_t> todo_;    // points with offers, ascending
  std::vector<LeastChord> next_;       // of todo_
  std::mutex mutex_;
  std::vector<std::unique_ptr<ChordDescent>> idle_;  // guarded by mutex_
};

}  // namespace

std::vector<LeastChord> refine(const PieceInput& input, const Lattice& lattice,
                               const DirectionSet& directions, const ErosionField& seeds,
                               const RefineOptions& options, ExecutionContext& context, RefineCost* cost) {
  Refinement refinement(input, lattice, options.threads, context);
  refinement.begin(directions, seeds);
  int rounds = 0;
  while (rounds < options.most_rounds && refinement.propagate()) ++rounds;
  if (cost != nullptr) *cost = {rounds, refinement.evaluations()};
  return refinement.take();
}

}  // namespace affskel::core
