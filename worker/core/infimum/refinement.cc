#include "core/infimum/refinement.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/lattice/lattice_edges.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kNobody = FieldValue::kNoDirection;
constexpr std::size_t kBlock = 64;  // points that a thread takes at once

constexpr double kSeedRounding = 1e-9;  // seeds have 36 bits

// When a neighbour's plane is worth a descent, by the volume E + |grad E| n.(x - y) that it promises at x.
constexpr double kPromised = 1.2;    // at most so many times what is known
constexpr double kFirst = 3;         // the piece that the descent begins with, likewise
constexpr double kAlike = 0.98;      // cosine between planes of one basin
constexpr double kNoBetter = 0.999;  // alike planes that promise no less than this are of one basin
constexpr double kLess = 1e-10;      // by which a piece must be less to take the place of another

}  // namespace

Refinement::Refinement(const PieceInput& input, const Lattice& lattice, unsigned threads)
    : input_(input),
      grid_(lattice.grid),
      threads_(threads),
      around_(lattice.points),
      least_(lattice.points),
      round_(lattice.points, 0) {
  std::vector<std::uint32_t> all(lattice.points);
  std::iota(all.begin(), all.end(), 0U);
  places_ = lattice_places(lattice, all);
  for (auto& around : around_) around.fill(kNobody);
  for_each_edge(lattice, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto&) {
    around_[x][2 * axis] = y;
    around_[y][2 * axis + 1] = x;
  });
}

std::uint64_t Refinement::evaluations() const {
  std::uint64_t sum = 0;
  for (const auto& descent : idle_) sum += descent->evaluations();
  return sum;
}

std::vector<RefinedPoint> Refinement::descend(const DirectionSet& directions, const Seeds& seeds,
                                              PointRange range, ExecutionContext& context) {
  std::vector<RefinedPoint> found(range.end - range.begin);
  each_of(found.size(), context, [&](std::size_t i, ChordDescent& descent) {
    const std::uint32_t p = range.begin + static_cast<std::uint32_t>(i);
    const FieldValue seed = seeds(p);
    LeastChord start;
    start.normal = directions[seed.direction];
    start.erosion = seed.erosion;
    start.area = start.slope = seed.area;
    LeastChord least = descent.descend(at(p), start);
    if (!(least.erosion <= start.erosion * (1 + kSeedRounding))) least = start;
    found[i] = {p, least};
  });
  return found;
}

std::vector<RefinedPoint> Refinement::improve(int round, PointRange range, ExecutionContext& context) {
  const std::vector<std::uint32_t> todo = offered(round, range);
  std::vector<RefinedPoint> found(todo.size());
  each_of(todo.size(), context, [&](std::size_t i, ChordDescent& descent) {
    found[i] = {todo[i], least_of_offers(round, todo[i], descent)};
  });
  std::erase_if(found, [&](const RefinedPoint& f) { return !(f.least.erosion < least_[f.point].erosion); });
  return found;
}

Vec3 Refinement::at(std::uint32_t point) const {
  const auto& [i, j, k] = places_[point];
  return grid_place(grid_, i, j, k);
}

// Calls body(i, descent) for i < count.
template <class Body>
void Refinement::each_of(std::size_t count, ExecutionContext& context, const Body& body) {
  parallel_for(threads_, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    throw_if_stopped(&context);
    std::unique_ptr<ChordDescent> descent = borrow();
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) body(i, *descent);
    give_back(std::move(descent));
  });
}

// The points with a neighbour that the round before changed.
std::vector<std::uint32_t> Refinement::offered(int round, PointRange range) const {
  std::vector<std::uint32_t> todo;
  for (std::uint32_t p = range.begin; p < range.end; ++p) {
    const bool any = std::any_of(around_[p].begin(), around_[p].end(),
                                 [&](std::uint32_t q) { return q != kNobody && round_[q] + 1 == round; });
    if (any) todo.push_back(p);
  }
  return todo;
}

LeastChord Refinement::least_of_offers(int round, std::uint32_t p, ChordDescent& descent) const {
  const Vec3 x = at(p);
  LeastChord best = least_[p];
  std::array<const LeastChord*, 7> tried{&least_[p]};
  std::size_t tries = 1;
  for (const std::uint32_t q : around_[p]) {
    if (q == kNobody || round_[q] + 1 != round) continue;
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

std::unique_ptr<ChordDescent> Refinement::borrow() {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (idle_.empty()) return std::make_unique<ChordDescent>(input_);
  std::unique_ptr<ChordDescent> descent = std::move(idle_.back());
  idle_.pop_back();
  return descent;
}

void Refinement::give_back(std::unique_ptr<ChordDescent> descent) {
  const std::lock_guard<std::mutex> guard(mutex_);
  idle_.push_back(std::move(descent));
}

}  // namespace affskel::core
