#include "core/ridge/continued_field.h"

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/lattice/lattice_points.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kUnknown = 0xFFFFFFFFU;

struct Place {
  std::int32_t i, j, k;
};

// The neighbours of a place in a band, in lattice order.
template <class Visit>
void for_each_neighbour(const RowBand& band, const Place& of, Visit visit) {
  for (std::int32_t i = of.i - 1; i <= of.i + 1; ++i) {
    for (std::int32_t j = of.j - 1; j <= of.j + 1; ++j) {
      const RowBand::Row& row = band.row(i, j);
      const std::int32_t end = std::min(of.k + 2, row.end);
      for (std::int32_t k = std::max(of.k - 1, row.begin); k < end; ++k) {
        if (i != of.i || j != of.j || k != of.k)
          visit(Place{i, j, k}, static_cast<std::size_t>(row.offset + k));
      }
    }
  }
}

std::size_t number(const RowBand& band, const Place& place) {
  return static_cast<std::size_t>(band.at(place.i, place.j, place.k));
}

class Continuation {
 public:
  Continuation(const Lattice& lattice, RowBand band, const std::function<double(std::uint32_t)>& value,
               const std::function<Vec3(std::uint32_t)>& gradient, unsigned threads)
      : band_(std::move(band)),
        threads_(threads),
        nearest_(band_.places(), kUnknown),
        result_(band_.places(), 0.0F) {
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      const std::size_t at = number(band_, {i, j, k});
      nearest_[at] = kDeep;
      result_[at] = static_cast<float>(value(rank));
    });
    std::size_t at_surface = 0;
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t) {
      std::size_t inside = 0;
      for_each_neighbour(band_, {i, j, k},
                         [&](const Place&, std::size_t at) { inside += nearest_[at] != kUnknown; });
      if (inside == 26) return;
      nearest_[number(band_, {i, j, k})] = kPending;
      ++at_surface;
    });
    surface_.reserve(at_surface);
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      std::uint32_t& nearest = nearest_[number(band_, {i, j, k})];
      if (nearest != kPending) return;
      nearest = static_cast<std::uint32_t>(surface_.size());
      surface_.push_back({{i, j, k}, value(rank), gradient(rank)});
      front_.push_back({i, j, k});
    });
  }

  ContinuedField run() {
    while (!front_.empty()) advance();
    return {std::move(band_), std::move(result_)};
  }

 private:
  // One layer of places further out.  The new layer is marked only when it is done: a place never looks at
  // those of its own layer, so that their order does not matter.
  void advance() {
    std::deque<Place> next;
    for (const Place& from : front_) {
      for_each_neighbour(band_, from, [&](const Place& place, std::size_t at) {
        if (nearest_[at] != kUnknown) return;
        nearest_[at] = kPending;
        next.push_back(place);
      });
    }
    std::vector<std::uint32_t> found(next.size());
    parallel_ranges(threads_, next.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) found[n] = continue_to(next[n]);
    });
    for (std::size_t n = 0; n < next.size(); ++n) nearest_[number(band_, next[n])] = found[n];
    front_ = std::move(next);
  }

  // Sets the value at a place and returns the point of the surface that is nearest, the first of several.
  std::uint32_t continue_to(const Place& to) {
    std::int32_t least = std::numeric_limits<std::int32_t>::max();
    std::array<std::uint32_t, 26> nearest;
    std::size_t count = 0;
    for_each_neighbour(band_, to, [&](const Place&, std::size_t at) {
      const std::uint32_t point = nearest_[at];
      if (point >= kDeep) return;
      const std::int32_t distance = squared_distance(to, surface_[point].place);
      if (distance > least) return;
      if (distance < least) count = 0;
      least = distance;
      if (std::find(nearest.begin(), nearest.begin() + count, point) == nearest.begin() + count)
        nearest[count++] = point;
    });
    std::sort(nearest.begin(), nearest.begin() + count);
    double sum = 0;
    for (std::size_t n = 0; n < count; ++n) sum += continued(nearest[n], to);
    result_[number(band_, to)] = static_cast<float>(sum / static_cast<double>(count));
    return nearest[0];
  }

  double continued(std::uint32_t point, const Place& to) const {
    const auto& [from, value, gradient] = surface_[point];
    const Vec3 way{static_cast<double>(to.i - from.i), static_cast<double>(to.j - from.j),
                   static_cast<double>(to.k - from.k)};
    return std::clamp(value + dot(gradient, way), 0.0, value);
  }

  static std::int32_t squared_distance(const Place& a, const Place& b) {
    const std::int32_t i = a.i - b.i, j = a.j - b.j, k = a.k - b.k;
    return i * i + j * j + k * k;
  }

  static constexpr std::uint32_t kPending = kUnknown - 1, kDeep = kUnknown - 2;

  struct Known {
    Place place;
    double value = 0;
    Vec3 gradient;
  };

  RowBand band_;
  unsigned threads_;
  std::vector<std::uint32_t> nearest_;  // per place: of the surface, or of what is no place for it
  std::vector<float> result_;
  std::vector<Known> surface_;
  std::deque<Place> front_;  // while a vector grows it takes three times its memory
};

}  // namespace

ContinuedField continued_field(const Lattice& lattice, const std::function<double(std::uint32_t)>& value,
                               const std::function<Vec3(std::uint32_t)>& gradient,
                               std::span<const std::uint8_t> reach, unsigned threads) {
  return Continuation(lattice, RowBand(lattice, reach), value, gradient, threads).run();
}

}  // namespace affskel::core
