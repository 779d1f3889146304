#include "core/ridge/continued_field.h"

#include <algorithm>
#include <array>
#include <limits>

namespace affskel::core {
namespace {

constexpr std::uint32_t kUnknown = 0xFFFFFFFFU;

struct Place {
  std::int32_t i, j, k;
};

class Continuation {
 public:
  Continuation(const Lattice& lattice, const RowBand& band, std::span<const double> value,
               const std::function<Vec3(std::uint32_t)>& gradient)
      : band_(band),
        value_(value),
        gradient_(gradient),
        nearest_(band.places(), kUnknown),
        result_(band.places(), 0.0F),
        place_(value.size()) {
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      const auto at = static_cast<std::size_t>(band.at(i, j, k));
      nearest_[at] = rank;
      result_[at] = static_cast<float>(value[rank]);
      place_[rank] = {i, j, k};
    });
  }

  std::vector<float> run(std::span<const std::uint8_t> reach) {
    const std::int32_t steps = std::min(band_.margin(), find_front(reach));
    for (std::int32_t step = 0; step < steps && !front_.empty(); ++step) advance();
    return std::move(result_);
  }

 private:
  // How far from the nearest sample point the places lie that are asked for.  About a point that has the
  // depth n, n steps from the nearest place outside, a cube of n - 1 steps holds sample points alone; of a
  // way of `reach` steps out of it, straight along all axes at once, so many end outside.  Those of depth 1
  // are the first front.
  std::int32_t find_front(std::span<const std::uint8_t> reach) {
    std::vector<char> reached(reach.size(), 0);
    std::vector<std::uint32_t> layer;
    for (std::uint32_t rank = 0; rank < reach.size(); ++rank) {
      for_each_neighbour(place_[rank], [&](const Place&, std::int64_t at) {
        if (nearest_[static_cast<std::size_t>(at)] == kUnknown) reached[rank] = 1;
      });
      if (!reached[rank]) continue;
      layer.push_back(rank);
      front_.push_back(place_[rank]);
    }
    std::int32_t steps = 0;
    for (std::int32_t depth = 1; !layer.empty(); ++depth) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t rank : layer) {
        steps = std::max(steps, std::int32_t{reach[rank]} - depth + 1);
        for_each_neighbour(place_[rank], [&](const Place&, std::int64_t at) {
          const std::uint32_t to = nearest_[static_cast<std::size_t>(at)];
          if (to == kUnknown || reached[to]) return;
          reached[to] = 1;
          next.push_back(to);
        });
      }
      layer = std::move(next);
    }
    return steps;
  }

  // One layer of places further out.  The new layer is marked only when it is done: a place never looks at
  // those of its own layer, so that their order does not matter.
  void advance() {
    std::vector<Place> next;
    for (const Place& from : front_) {
      for_each_neighbour(from, [&](const Place& place, std::int64_t at) {
        std::uint32_t& known = nearest_[static_cast<std::size_t>(at)];
        if (known != kUnknown) return;
        known = kPending;
        next.push_back(place);
      });
    }
    std::vector<std::uint32_t> found(next.size());
    for (std::size_t n = 0; n < next.size(); ++n) found[n] = continue_to(next[n]);
    for (std::size_t n = 0; n < next.size(); ++n)
      nearest_[static_cast<std::size_t>(band_.at(next[n].i, next[n].j, next[n].k))] = found[n];
    front_ = std::move(next);
  }

  // Sets the value at a place and returns its nearest sample point, the one of least rank.
  std::uint32_t continue_to(const Place& to) {
    std::int32_t least = std::numeric_limits<std::int32_t>::max();
    std::array<std::uint32_t, 26> nearest;
    std::size_t count = 0;
    for_each_neighbour(to, [&](const Place&, std::int64_t at) {
      const std::uint32_t rank = nearest_[static_cast<std::size_t>(at)];
      if (rank >= kPending) return;
      const std::int32_t distance = squared_distance(to, place_[rank]);
      if (distance > least) return;
      if (distance < least) count = 0;
      least = distance;
      if (std::find(nearest.begin(), nearest.begin() + count, rank) == nearest.begin() + count)
        nearest[count++] = rank;
    });
    std::sort(nearest.begin(), nearest.begin() + count);
    double sum = 0;
    for (std::size_t n = 0; n < count; ++n) sum += continued(nearest[n], to);
    result_[static_cast<std::size_t>(band_.at(to.i, to.j, to.k))] =
        static_cast<float>(sum / static_cast<double>(count));
    return nearest[0];
  }

  double continued(std::uint32_t rank, const Place& to) const {
    const Place& from = place_[rank];
    const Vec3 way{static_cast<double>(to.i - from.i), static_cast<double>(to.j - from.j),
                   static_cast<double>(to.k - from.k)};
    return std::clamp(value_[rank] + dot(gradient_(rank), way), 0.0, value_[rank]);
  }

  static std::int32_t squared_distance(const Place& a, const Place& b) {
    const std::int32_t i = a.i - b.i, j = a.j - b.j, k = a.k - b.k;
    return i * i + j * j + k * k;
  }

  // The neighbours in the band, in lattice order.
  template <class Visit>
  void for_each_neighbour(const Place& of, Visit visit) const {
    for (std::int32_t i = of.i - 1; i <= of.i + 1; ++i) {
      for (std::int32_t j = of.j - 1; j <= of.j + 1; ++j) {
        const RowBand::Row& row = band_.row(i, j);
        const std::int32_t end = std::min(of.k + 2, row.end);
        for (std::int32_t k = std::max(of.k - 1, row.begin); k < end; ++k) {
          if (i != of.i || j != of.j || k != of.k) visit(Place{i, j, k}, row.offset + k);
        }
      }
    }
  }

  static constexpr std::uint32_t kPending = kUnknown - 1;

  const RowBand& band_;
  std::span<const double> value_;
  const std::function<Vec3(std::uint32_t)>& gradient_;
  std::vector<std::uint32_t> nearest_;  // per place: a sample point, kPending or kUnknown
  std::vector<float> result_;
  std::vector<Place> place_;  // per sample point
  std::vector<Place> front_;
};

}  // namespace

std::vector<float> continued_field(const Lattice& lattice, const RowBand& band, std::span<const double> value,
                                   const std::function<Vec3(std::uint32_t)>& gradient,
                                   std::span<const std::uint8_t> reach) {
  return Continuation(lattice, band, value, gradient).run(reach);
}

}  // namespace affskel::core
