#include "core/infimum/refinement.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/unit.h"
#include "core/infimum/wider_look.h"
#include "core/lattice/lattice_edges.h"

namespace affskel::core {
namespace {

constexpr std::size_t kBlock = 64;  // points that a thread takes at once

constexpr double kSeedRounding = 1e-9;  // seeds have 36 bits

constexpr double kPromised = 1.02;   // a neighbour's plane may promise so many times what is known
constexpr double kFirst = 3;         // the piece that the descent begins with, likewise
constexpr double kNoBetter = 0.999;  // alike planes that promise no less than this are of one basin
constexpr double kLess = 1e-7;       // by which a piece must be less to take the place of another
constexpr double kSeedHope = 2;      // how many times what neighbours led to a seed may be

// DescentBound::promise: of a point that has nothing yet but its seed, and of others.
constexpr double kFollowPromise = 4, kOfferPromise = 1;

}  // namespace

Refinement::Refinement(const PieceInput& input, const Lattice& lattice, unsigned threads)
    : input_(input),
      grid_(lattice.grid),
      threads_(threads),
      around_(lattice.points),
      least_(lattice.points),
      round_(lattice.points, 0),
      first_(lattice.points, 0) {
  std::vector<std::uint32_t> all(lattice.points);
  std::iota(all.begin(), all.end(), 0U);
  places_ = lattice_places(lattice, all);
  for (auto& around : around_) around.fill(kNone);
  for_each_edge(lattice, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto&) {
    around_[x][2 * axis] = y;
    around_[y][2 * axis + 1] = x;
  });
  find_first_rounds();
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
    found[i] = {p, first_[p] == 0 ? from_seed(p, start, descent) : start};
  });
  return found;
}

std::vector<RefinedPoint> Refinement::improve(int round, PointRange range, ExecutionContext& context) {
  const std::vector<std::uint32_t> points = to_do(round, range);
  std::vector<RefinedPoint> found(points.size());
  each_of(points.size(), context, [&](std::size_t i, ChordDescent& descent) {
    const std::uint32_t p = points[i];
    found[i] = {p, round < look_round_ ? follow(round, p, descent) : look(round, p, descent)};
  });
  std::erase_if(found, [&](const RefinedPoint& f) {
    return first_[f.point] < round && !(f.least.erosion < least_[f.point].erosion);
  });
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

// A point begins in the round after the last of the neighbours that have fewer odd indices.
void Refinement::find_first_rounds() {
  const auto odd = [&](std::uint32_t p) {
    return (places_[p][0] & 1U) + (places_[p][1] & 1U) + (places_[p][2] & 1U);
  };
  for (unsigned odds = 1; odds <= 3; ++odds) {
    for (std::uint32_t p = 0; p < around_.size(); ++p) {
      if (odd(p) != odds) continue;
      for (const std::uint32_t q : around_[p]) {
        if (q != kNone && odd(q) < odds) first_[p] = std::max<std::uint8_t>(first_[p], first_[q] + 1);
      }
    }
  }
  for (const std::uint8_t first : first_) look_round_ = std::max(look_round_, first + 1);
}

// Whether the round before changed something one or two steps away.
bool Refinement::has_news(std::uint32_t p, int round) const {
  return std::ranges::any_of(around_[p], [&](std::uint32_t q) {
    return q != kNone && (is_news(q, round) || std::ranges::any_of(around_[q], [&](std::uint32_t r) {
                            return r != kNone && r != p && is_news(r, round);
                          }));
  });
}

std::vector<std::uint32_t> Refinement::to_do(int round, PointRange range) const {
  std::vector<std::uint32_t> points;
  for (std::uint32_t p = range.begin; p < range.end; ++p) {
    if (round < look_round_ ? first_[p] == round : round == look_round_ || has_news(p, round))
      points.push_back(p);
  }
  return points;
}

// A point that begins, begins with its seed.
LeastChord Refinement::from_seed(std::uint32_t p, const LeastChord& seed, ChordDescent& descent) const {
  const Vec3 x = at(p);
  const LeastChord least = descent.descend(x, seed);
  return least.erosion <= seed.erosion * (1 + kSeedRounding) ? descent.look_across(x, least) : seed;
}

// What the neighbours offer, what promises least first.  Two opposite ones of one basin offer one plane.
std::size_t Refinement::list_offers(int round, std::uint32_t p, std::array<Offer, 6>& offers) const {
  const Vec3 x = at(p);
  std::size_t count = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::uint32_t q = around_[p][i], opposite = around_[p][i ^ 1U];
    if (!has_begun(q, round)) continue;
    Offer& offer = offers[count++];
    offer = {least_[q], promised(least_[q], x - at(q))};
    if (!has_begun(opposite, round) || least_[opposite].saddles != offer.start.saddles ||
        !alike(least_[opposite], offer.start)) {
      continue;
    }
    offer.start.normal = unit(offer.start.normal + least_[opposite].normal);
    offer.promise = 0.5 * (offer.promise + promised(least_[opposite], x - at(opposite)));
    i |= 1U;
  }
  std::stable_sort(offers.begin(), offers.begin() + static_cast<std::ptrdiff_t>(count),
                   [](const Offer& a, const Offer& b) { return a.promise < b.promise; });
  return count;
}

// A point that begins: from what its neighbours have, and from its seed where that leads elsewhere.
LeastChord Refinement::follow(int round, std::uint32_t p, ChordDescent& descent) const {
  const Vec3 x = at(p);
  const LeastChord& start = least_[p];
  LeastChord best = start;
  bool lower = false;
  std::array<Offer, 6> offers;
  const std::size_t count = list_offers(round, p, offers);
  std::array<const LeastChord*, 6> tried;
  std::size_t tries = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Offer& offer = offers[i];
    const bool less = offer.promise < kNoBetter * best.erosion;
    const bool known = std::any_of(tried.begin(), tried.begin() + tries, [&](const LeastChord* other) {
      return (!less || other->saddles == offer.start.saddles) && alike(*other, offer.start);
    });
    if (known || offer.promise > kPromised * best.erosion) continue;
    tried[tries++] = &offer.start;
    const LeastChord found = descent.descend(x, offer.start,
                                             {kFirst * best.erosion, best.erosion * (lower ? 1 - kLess : 1),
                                              lower ? kOfferPromise : kFollowPromise});
    if (!(found.erosion < best.erosion * (1 - kLess))) continue;
    best = found;
    lower = true;
  }
  if (!(lower && alike(best, start)) && start.erosion < kSeedHope * best.erosion) {
    const double bound = best.erosion * (lower ? 1 : 1 + kSeedRounding);
    const LeastChord own = descent.descend(x, start, {kFirst * best.erosion, bound, kFollowPromise});
    if (own.erosion <= bound) {
      best = own;
      lower = true;
    }
  }
  return lower ? descent.look_across(x, best) : best;
}

LeastChord Refinement::look(int round, std::uint32_t p, ChordDescent& descent) const {
  const NearPlaces near(grid_, around_, least_, p);
  return look_wider(
      input_, at(p), p, near, least_, [&](std::uint32_t q) { return is_news(q, round); }, descent);
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
