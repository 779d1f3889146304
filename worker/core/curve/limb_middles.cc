#include "core/curve/limb_middles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/base/groups.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {
namespace {

// The ball about a vertex, by its local radius; see the header.
constexpr double kBall = 1.6;

// On a torus three times as wide as its tube what is left to go falls by a sixth each round.
constexpr int kRounds = 20;

class Middles {
 public:
  Middles(const LimbMiddlesInput& input, std::vector<Vec3> places)
      : input_(input),
        places_(std::move(places)),
        neighbours_(places_.size(),
                    [&](const auto& put) {
                      for (const auto& [a, b] : input.segments) {
                        put(a, b);
                        put(b, a);
                      }
                    }),
        points_(places_.size(), [&](const auto& put) {
          for (std::uint32_t p = 0; p < input.nearest.size(); ++p)
            if (input.nearest[p] != DualComplex::kNone) put(input.nearest[p], p);
        }) {
    point_places_.reserve(input.lattice.points);
    for (const LatticeRun& run : input.lattice.axis[2].runs)
      for (std::uint32_t n = 0; n < run.length; ++n)
        point_places_.push_back({static_cast<float>(run.start[0]), static_cast<float>(run.start[1]),
                                 static_cast<float>(run.start[2] + n)});
    for (std::uint32_t v = 0; v < places_.size(); ++v) radius_.push_back(local_radius(v));
  }

  std::vector<Vec3> run() {
    StopCheck stop(input_.context);
    for (int round = 0; round < kRounds; ++round) {
      std::vector<Vec3> moved = places_;
      for (std::uint32_t v = 0; v < places_.size(); ++v) {
        if (neighbours_[v].size() != 2) continue;
        moved[v] = middle(v);
        stop.did(1000);
      }
      places_ = std::move(moved);
    }
    return std::move(places_);
  }

 private:
  using Place = std::array<float, 3>;

  // The vertices that a line leads to from one within a length, the first of all.
  void gather(std::uint32_t from, double length) {
    stretch_.assign(1, {from, 0});
    for (std::size_t n = 0; n < stretch_.size(); ++n) {
      const auto [v, way] = stretch_[n];
      for (const std::uint32_t to : neighbours_[v]) {
        const double there = way + norm(places_[to] - places_[v]);
        if (there > length) continue;
        if (std::none_of(stretch_.begin(), stretch_.end(),
                         [&](const auto& known) { return known.first == to; }))
          stretch_.push_back({to, there});
      }
    }
  }

  Vec3 middle(std::uint32_t v) {
    const Vec3 at = places_[v];
    const double ball = kBall * radius_[v];
    gather(v, 2 * ball);
    Vec3 sum;
    double count = 0, nearest = std::numeric_limits<double>::infinity();
    for (const auto& [along, way] : stretch_) {
      for (const std::uint32_t p : points_[along]) {
        const Vec3 off = Vec3{point_places_[p][0], point_places_[p][1], point_places_[p][2]} - at;
        const double square = dot(off, off);
        if (square < nearest) {
          nearest = square;
          radius_[v] = static_cast<double>(input_.radius[p]);
        }
        if (square > ball * ball) continue;
        sum = sum + off;
        ++count;
      }
    }
    if (count == 0) return at;
    const auto around = neighbours_[v];
    const Vec3 line = places_[around[1]] - places_[around[0]];
    const double square = dot(line, line);
    Vec3 way = (1 / count) * sum;
    if (square > 0) way = way - (dot(way, line) / square) * line;
    return at + way;
  }

  // Of the sample point next to a vertex, of those that are its own.
  double local_radius(std::uint32_t v) const {
    double nearest = std::numeric_limits<double>::infinity(), radius = 1;
    for (const std::uint32_t p : points_[v]) {
      const Vec3 off = Vec3{point_places_[p][0], point_places_[p][1], point_places_[p][2]} - places_[v];
      if (dot(off, off) >= nearest) continue;
      nearest = dot(off, off);
      radius = static_cast<double>(input_.radius[p]);
    }
    return radius;
  }

  const LimbMiddlesInput& input_;
  std::vector<Vec3> places_;
  Groups<std::uint32_t> neighbours_, points_;  // per vertex
  std::vector<Place> point_places_;            // per sample point, spacings
  std::vector<double> radius_;                 // per vertex: of the sample point next to it
  std::vector<std::pair<std::uint32_t, double>> stretch_;
};

}  // namespace

std::vector<Vec3> limb_middles(const LimbMiddlesInput& input, std::vector<Vec3> places) {
  return Middles(input, std::move(places)).run();
}

}  // namespace affskel::core
