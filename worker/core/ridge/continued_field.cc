#include "core/ridge/continued_field.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace affskel::core {
namespace {

constexpr std::uint32_t kUnknown = 0xFFFFFFFFU;

struct Place {
  std::int32_t i, j, k;
};

constexpr std::uint8_t kInside = 0x80;  // a place asked for that is a sample point

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

// What is asked for, and where sample points have a place outside beside them.
struct Asked {
  RowBand band;
  std::vector<Place> surface;
};

// From reach + 1 at the sample points down, n - 1 at the places beside one of n; those above 0 are asked for.
Asked find_asked(const RowBand& wide, const std::vector<Place>& points, std::span<const std::uint8_t> reach) {
  std::vector<std::uint8_t> asked(wide.places(), 0);
  std::array<std::vector<Place>, kInside> asking;  // by n
  for (std::uint32_t rank = 0; rank < reach.size(); ++rank) {
    asked[number(wide, points[rank])] = static_cast<std::uint8_t>(kInside | (reach[rank] + 1));
    asking[reach[rank] + 1U].push_back(points[rank]);
  }
  std::vector<Place> surface;
  for (std::size_t n = asking.size(); n-- > 1; asking[n] = {}) {
    for (const Place& from : asking[n]) {
      const std::uint8_t here = asked[number(wide, from)];
      if ((here & ~kInside) > static_cast<int>(n)) continue;  // it has asked for more
      bool at_surface = false;
      for_each_neighbour(wide, from, [&](const Place& place, std::size_t at) {
        const std::uint8_t inside = asked[at] & kInside;
        at_surface = at_surface || inside == 0;
        if ((asked[at] & ~kInside) + 1 >= static_cast<int>(n)) return;
        asked[at] = static_cast<std::uint8_t>(inside | (n - 1));
        asking[n - 1].push_back(place);
      });
      if (at_surface && (here & kInside) != 0) surface.push_back(from);
    }
  }
  return {RowBand(wide, asked), std::move(surface)};
}

class Continuation {
 public:
  Continuation(std::vector<Place> points, Asked asked, std::span<const double> value,
               const std::function<Vec3(std::uint32_t)>& gradient)
      : band_(std::move(asked.band)),
        value_(value),
        gradient_(gradient),
        nearest_(band_.places(), kUnknown),
        result_(band_.places(), 0.0F),
        place_(std::move(points)),
        front_(std::move(asked.surface)) {
    for (std::uint32_t rank = 0; rank < place_.size(); ++rank) {
      const std::size_t at = number(band_, place_[rank]);
      nearest_[at] = rank;
      result_[at] = static_cast<float>(value[rank]);
    }
  }

  ContinuedField run() {
    while (!front_.empty()) advance();
    return {std::move(band_), std::move(result_)};
  }

 private:
  // One layer of places further out.  The new layer is marked only when it is done: a place never looks at
  // those of its own layer, so that their order does not matter.
  void advance() {
    std::vector<Place> next;
    for (const Place& from : front_) {
      for_each_neighbour(band_, from, [&](const Place& place, std::size_t at) {
        if (nearest_[at] != kUnknown) return;
        nearest_[at] = kPending;
        next.push_back(place);
      });
    }
    std::vector<std::uint32_t> found(next.size());
    for (std::size_t n = 0; n < next.size(); ++n) found[n] = continue_to(next[n]);
    for (std::size_t n = 0; n < next.size(); ++n) nearest_[number(band_, next[n])] = found[n];
    front_ = std::move(next);
  }

  // Sets the value at a place and returns its nearest sample point, the one of least rank.
  std::uint32_t continue_to(const Place& to) {
    std::int32_t least = std::numeric_limits<std::int32_t>::max();
    std::array<std::uint32_t, 26> nearest;
    std::size_t count = 0;
    for_each_neighbour(band_, to, [&](const Place&, std::size_t at) {
      const std::uint32_t rank = nearest_[at];
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
    result_[number(band_, to)] = static_cast<float>(sum / static_cast<double>(count));
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

  static constexpr std::uint32_t kPending = kUnknown - 1;

  RowBand band_;
  std::span<const double> value_;
  const std::function<Vec3(std::uint32_t)>& gradient_;
  std::vector<std::uint32_t> nearest_;  // per place: a sample point, kPending or kUnknown
  std::vector<float> result_;
  std::vector<Place> place_;  // per sample point
  std::vector<Place> front_;
};

}  // namespace

ContinuedField continued_field(const Lattice& lattice, std::span<const double> value,
                               const std::function<Vec3(std::uint32_t)>& gradient,
                               std::span<const std::uint8_t> reach) {
  std::vector<Place> points(value.size());
  for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
    points[rank] = {i, j, k};
  });
  const RowBand wide(lattice, std::max(1, std::int32_t{*std::max_element(reach.begin(), reach.end())}));
  Asked asked = find_asked(wide, points, reach);
  return Continuation(std::move(points), std::move(asked), value, gradient).run();
}

}  // namespace affskel::core
