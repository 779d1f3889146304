#include "core/curve/centre_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "core/base/matrix3.h"
#include "core/base/parallel.h"
#include "core/base/symmetric_eigen.h"
#include "core/base/unit.h"
#include "core/curve/joint_balls.h"
#include "core/curve/limb_forks.h"
#include "core/curve/line_ends.h"
#include "core/mesh/edges.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Each pass is a step to the mean of the neighbours and a longer one back: what is shorter than about fifteen
// segments goes, what is longer stays.
constexpr int kPasses = 300, kLaterPasses = 40;
constexpr double kStep = 0.5, kStepBack = -0.51;

constexpr double kRoom =
    0.8;  // of its ball, what a vertex has in a round: from beside the surface none comes back
constexpr int kRounds = 5;         // sections are across lines that the last round has moved
constexpr int kRest = 5;           // rounds more, at most, until joints have settled
constexpr double kSettled = 0.05;  // spacings: of all joints, less than that in a round is no move
constexpr double kDirection = 1;   // radii: over so long a stretch on both sides a line has its direction
constexpr double kFitted = 5;      // vertices that tell of a parabola
// Radius of the largest disc about the centroid over that of a disc as large: a section that is rounder has a middle, in
// one that is flatter the line stays in the middle of the sheet.  An ellipse 2:1 has 0.71.
constexpr double kRoundSection = 0.75, kFlatSection = 0.55;
// How strongly a joint is held where it is, beside the lines of its limbs: along lines that go straight on.
constexpr double kHold = 0.02;

// Times its length a limb's direction tells where it leads.
constexpr double kTold = 3;

// The mean of the squared sines between a direction and the lines of a joint: along one with less than the first, lines
// that are about parallel do not tell where they meet, and with more than the other they do.
constexpr double kParallel = 0.08, kOblique = 0.15;

// Of the largest ball about where a joint began, or about the nearer end of a straight stretch: with less a line is not in
// the middle.
constexpr double kMiddle = 0.45;
constexpr int kTries = 4;  // the half of a way that leads too far, before it is none

constexpr double kFarForks = 2;  // sizes of a joint: how limbs part farther from there says nothing of it

// The parabola through places at times t, by least squares.
class ParabolaFit {
 public:
  void add(double t, const Vec3& place) {
    const Vec3 powers{1, t, t * t};
    sums_ = sums_ + outer(powers, powers);
    places_ = places_ + outer(place, powers);
  }
  Vec3 at_0() const {
    const Vec3 row = inverse_transposed(sums_)[0];  // the sums are symmetric
    return row.x * places_[0] + row.y * places_[1] + row.z * places_[2];
  }

 private:
  Matrix3 sums_{}, places_{};
};

class CentreLines {
 public:
  CentreLines(const CentreLinesInput& input, std::vector<Vec3>& places)
      : input_(input),
        places_(places),
        surface_(input.surface),
        lines_(polylines(places.size(), input.segments)),
        neighbours_(neighbours(places.size(), input.segments)),
        thickness_(places.size()),
        ball_(places.size()) {}

  void run() {
    find_balls();
    make_smooth(kPasses, false);
    start_ = places_;
    for (int round = 0; round < kRounds + kRest; ++round) {
      throw_if_stopped(input_.context);
      find_balls();
      to_middle();
      const double moved = meet();
      make_smooth(kLaterPasses, true);
      if (round + 1 >= kRounds && moved < kSettled * input_.spacing) break;
    }
    for (const auto& line : lines_) find_ends(line);
  }

 private:
  bool is_joint(std::uint32_t v) const { return neighbours_[v].size() > 2; }
  bool inside(const Vec3& place) const { return surface_.membership.contains(place); }

  // Ends stay where they are.
  void make_smooth(int passes, bool joints_stay) {
    std::vector<Vec3> before;
    const auto move = [&](double step) {
      before = places_;
      for (std::uint32_t v = 0; v < places_.size(); ++v) {
        const auto around = neighbours_[v];
        if (around.size() < 2 || (joints_stay && around.size() > 2)) continue;
        Vec3 mean;
        for (const std::uint32_t to : around)
          mean = mean + (1 / static_cast<double>(around.size())) * before[to];
        go(v, before[v] + step * (mean - before[v]));
      }
    };
    for (int pass = 0; pass < passes; ++pass) {
      throw_if_stopped(input_.context);
      move(kStep);
      move(kStepBack);
    }
  }

  // The largest balls in the solid about the vertices.
  void find_balls() {
    home_ = places_;
    parallel_for(input_.threads, home_.size(), [&](std::size_t v) {
      ball_[v] = surface_.distance.nearest(home_[v]);
      thickness_[v] = surface_.sections.thickness(home_[v], ball_[v]);
    });
    joints_ = joint_balls(places_, lines_, thickness_);
  }

  // A vertex goes to a place, or as near to it as its ball reaches: what stays in a ball in the solid never leaves the
  // solid.
  void go(std::uint32_t v, const Vec3& to) {
    const Vec3 way = to - home_[v];
    const double length = norm(way), room = kRoom * ball_[v];
    places_[v] = length <= room ? to : home_[v] + (room / length) * way;
  }

  // How many vertices from an end of a line lie near the joint there; 0 where none is.
  std::size_t in_joint(const std::vector<std::uint32_t>& line, bool from_last) const {
    const auto at = [&](std::size_t n) { return point_from(from_last, line, n); };
    if (!is_joint(at(0))) return 0;
    const JointBalls& joint = joints_[at(0)];
    std::size_t count = 1;
    while (count < line.size() && joint.hold(places_[at(count)])) ++count;
    return count;
  }

  struct Free {
    std::size_t first = 0, last = 0;  // of a line, the vertices that are in no joint
    std::size_t count() const { return std::max(first, last) - first; }
  };
  Free free_part(const std::vector<std::uint32_t>& line) const {
    return {in_joint(line, false), line.size() - in_joint(line, true)};
  }

  // Of a line at its n-th vertex, by a stretch on both sides.
  Vec3 direction(const std::vector<std::uint32_t>& line, std::size_t n, double stretch) const {
    const bool closed = line.front() == line.back() && !is_joint(line.front());
    const std::size_t count = closed ? line.size() - 1 : line.size();
    const auto go = [&](std::size_t step) {  // 1 forth, count - 1 back
      std::size_t k = n % count;
      for (std::size_t steps = 0; steps < count / 2; ++steps) {
        if (norm(places_[line[k]] - places_[line[n]]) >= stretch) break;
        if (!closed && (step == 1 ? k + 1 == count : k == 0)) break;
        k = (k + step) % count;
      }
      return places_[line[k]];
    };
    return unit(go(1) - go(count - 1));
  }

  // How far a vertex is from the middle of its section, and how much that says.
  struct Shift {
    Vec3 way;
    double weight = 0, ball = 0;
  };

  Shift shift_of(const std::vector<std::uint32_t>& line, std::size_t n) const {
    const Vec3& at = places_[line[n]];
    Shift shift;
    shift.ball = thickness_[line[n]];
    const Vec3 across = direction(line, n, kDirection * shift.ball + input_.spacing);
    if (across == Vec3{} || !(shift.ball > 0)) return shift;
    const LimbSection section = surface_.sections.at(at, across, shift.ball);
    const double away = norm(section.centre - at);
    if (away >= shift.ball && !inside(section.centre)) return shift;
    shift.way = section.centre - at;
    shift.weight = weight_of(section, shift.ball, away);
    return shift;
  }

  // What the middle of a section says, by how round it is.  The distance from there to the surface differs from that of
  // the vertex, `away` from there, by as much at most, which is mostly enough to know.
  double weight_of(const LimbSection& section, double ball, double away) const {
    const double size = std::max(section.radius, ball);
    if (ball - away >= kRoundSection * size) return 1;
    if (ball + away <= kFlatSection * size) return 0;
    const double roundness = surface_.distance.nearest(section.centre) / size;
    return std::clamp((roundness - kFlatSection) / (kRoundSection - kFlatSection), 0.0, 1.0);
  }

  // Each goes to a parabola through what lies within a radius on either side, so that no bend is narrower, and by the mean
  // of the shifts there.  Means of the shifts alone leave waves of half that length.
  void to_middle() {
    std::vector<Free> free;
    std::vector<std::pair<std::size_t, std::size_t>> all;  // lines, and their vertices that are free
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      free.push_back(free_part(lines_[l]));
      for (std::size_t n = free[l].first; n < free[l].last; ++n) all.push_back({l, n});
    }
    std::vector<Shift> shifts(all.size());
    parallel_for(input_.threads, all.size(),
                 [&](std::size_t k) { shifts[k] = shift_of(lines_[all[k].first], all[k].second); });
    std::size_t before = 0;
    for (std::size_t l = 0; l < lines_.size(); before += free[l].count(), ++l)
      to_middle(lines_[l], free[l], std::span(shifts).subspan(before, free[l].count()));
  }

  void to_middle(const std::vector<std::uint32_t>& line, const Free& free, std::span<const Shift> shifts) {
    std::vector<double> along;
    std::vector<Vec3> before;
    for (std::size_t n = free.first; n < free.last; ++n) {
      along.push_back(n == free.first ? 0 : along.back() + norm(places_[line[n]] - before.back()));
      before.push_back(places_[line[n]]);
    }
    std::size_t low = 0;
    for (std::size_t n = 0; n < shifts.size(); ++n) {
      const double stretch = kDirection * shifts[n].ball;
      while (along[n] - along[low] > stretch) ++low;
      while (low > 0 && along[n] - along[low - 1] <= stretch) --low;
      Vec3 sum;
      double count = 0;
      ParabolaFit fit;
      for (std::size_t k = low; k < shifts.size() && along[k] - along[n] <= stretch; ++k, ++count) {
        sum = sum + shifts[k].weight * shifts[k].way;
        fit.add((along[k] - along[n]) / stretch, before[k]);
      }
      go(line[free.first + n], (count < kFitted ? before[n] : fit.at_0()) + (1 / count) * sum);
    }
  }

  // Where the lines of a joint meet, by least squares.
  struct Meeting {
    Matrix3 sum{}, angles{};
    Vec3 side;
    double lines = 0;
    double untold = 0;  // weight that limbs lack, which are short beside the way from there to the joint
  };

  // Joints, and what lies in their balls.
  // @return how far they move, at most.
  double meet() {
    std::vector<Free> free;
    for (const auto& line : lines_) free.push_back(free_part(line));
    forks_ = limb_forks(places_, lines_, surface_.sections, input_.spacing);
    std::vector<Meeting> meetings(places_.size());
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      if (free[l].first >= free[l].last) continue;
      for (const bool from_last : {false, true}) {
        const std::uint32_t joint = from_last ? lines_[l].back() : lines_[l].front();
        if (is_joint(joint)) add_line(lines_[l], free[l], from_last, meetings[joint]);
      }
    }
    double moved = 0;
    for (std::uint32_t v = 0; v < places_.size(); ++v) {
      if (!is_joint(v)) continue;
      const Vec3 before = places_[v];
      move_joint(v, meetings[v]);
      moved = std::max(moved, norm(places_[v] - before));
    }
    for (std::size_t l = 0; l < lines_.size(); ++l) draw_straight(lines_[l], free[l]);
    return moved;
  }

  // |(x - q) x t|^2, by the square of the limb's thickness there.
  void add_line(const std::vector<std::uint32_t>& line, const Free& free, bool from_last,
                Meeting& meeting) const {
    std::vector<std::uint32_t> inwards(line.begin() + static_cast<std::ptrdiff_t>(free.first),
                                       line.begin() + static_cast<std::ptrdiff_t>(free.last));
    if (from_last) std::reverse(inwards.begin(), inwards.end());
    const Vec3& q = places_[inwards[0]];
    const double ball = surface_.thickness(q);
    const double gap = norm(places_[from_last ? line.back() : line.front()] - q);
    const Vec3 t = outward(places_, inwards, 2 * kDirection * ball + input_.spacing, gap);
    if (t == Vec3{}) return;
    const double length = kTold * norm(places_[inwards.back()] - q);
    const double told = length < gap ? length * length / (gap * gap) : 1;
    const double weight = told * ball * ball;
    const Vec3 to = q - dot(q, t) * t;
    meeting.side = meeting.side + weight * to;
    meeting.lines += 1;
    meeting.untold += (1 - told) * ball * ball;
    const Matrix3 across = kIdentity3 + -1.0 * outer(t, t);
    meeting.sum = meeting.sum + weight * across;
    meeting.angles = meeting.angles + across;
  }

  // As far as its lines tell where they meet, and that is near; else by where they part.
  void move_joint(std::uint32_t v, const Meeting& meeting) {
    const double trace = meeting.sum[0].x + meeting.sum[1].y + meeting.sum[2].z;
    if (!(trace > 0)) return;
    const double hold = kHold * trace;
    const Vec3 met = transposed_times(inverse_transposed(meeting.sum + (hold + meeting.untold) * kIdentity3),
                                      meeting.side + hold * places_[v] + meeting.untold * start_[v]);
    const SymmetricEigen told = symmetric_eigen((1 / meeting.lines) * meeting.angles);
    Vec3 way;
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = std::clamp((told.values[k] - kParallel) / (kOblique - kParallel), 0.0, 1.0);
      const Vec3& along = told.vectors[k];
      const double rest = share < 1 ? by_forks(v, along) : 0;
      way = way + (share * dot(met - start_[v], along) + (1 - share) * rest) * along;
    }
    const double away = norm(way), size = joints_[v].size;
    go_in_middle(v, (away > size ? std::max(0.0, 2 * size - away) / away : 1) * way);
  }

  // From where a joint began, as far as it stays in the middle.
  void go_in_middle(std::uint32_t v, Vec3 way) {
    const double least = kMiddle * surface_.distance.nearest(start_[v]);
    for (int half = 0; half < kTries; ++half, way = 0.5 * way)
      if (inside(start_[v] + way) && surface_.distance.nearest(start_[v] + way) >= least)
        return go(v, start_[v] + way);
    go(v, start_[v]);
  }

  // Of a limb where it leaves its joint.
  double thickness_of(const LineEnd& limb) const {
    const auto& line = lines_[limb.line];
    const std::size_t n = std::min(in_joint(line, limb.back), line.size() - 1);
    return thickness_[point_from(limb.back, line, n)];
  }

  // How far along a direction a joint lies from where it began, that limbs part as far from it as they are thick.
  double by_forks(std::uint32_t v, const Vec3& along) const {
    double sum = 0, count = 0;
    for (const LimbFork& fork : forks_[v]) {
      const Vec3 way = fork.place - places_[v];
      const double weight = ahead(way, along) * std::max(0.0, kFarForks * joints_[v].size - norm(way));
      if (!(weight > 0)) continue;
      const double thick = 0.5 * (thickness_of(fork.limbs[0]) + thickness_of(fork.limbs[1]));
      sum += weight * (dot(fork.place - start_[v], along) - std::copysign(thick, dot(way, along)));
      count += weight;
    }
    return count > 0 ? sum / count : 0;
  }

  // From the joint to the first vertex that is free, and from joint to joint where none is; where that leads past a notch,
  // it stays.
  void draw_straight(const std::vector<std::uint32_t>& line, const Free& free) {
    const auto draw = [&](std::size_t from, std::size_t to) {
      const Vec3 a = places_[line[from]], b = places_[line[to]];
      const double least = kMiddle * std::min(surface_.distance.nearest(a), surface_.distance.nearest(b));
      std::vector<Vec3> straight;
      for (std::size_t n = from + 1; n < to; ++n) {
        straight.push_back(a + (static_cast<double>(n - from) / static_cast<double>(to - from)) * (b - a));
        if (surface_.distance.nearest(straight.back()) < least) return;
      }
      for (std::size_t n = from + 1; n < to; ++n) go(line[n], straight[n - from - 1]);
    };
    if (free.first >= free.last) {
      if (line.front() != line.back()) draw(0, line.size() - 1);
      return;
    }
    if (free.first > 0) draw(0, free.first);
    if (free.last < line.size()) draw(free.last - 1, line.size() - 1);
  }

  void find_ends(std::vector<std::uint32_t> line) {
    for (int end = 0; end < 2; ++end, std::reverse(line.begin(), line.end()))
      if (line.size() > 1 && neighbours_[line[0]].size() == 1 && input_.has_tip[line[0]])
        draw_end({surface_, input_.spacing, line, in_joint(line, true), input_.tip[line[0]]}, places_);
  }

  const CentreLinesInput& input_;
  std::vector<Vec3>& places_;
  const LimbSurface& surface_;
  const std::vector<std::vector<std::uint32_t>> lines_;
  const Adjacency neighbours_;
  std::vector<Vec3> start_;                   // once smooth
  std::vector<Vec3> home_;                    // where the round has found the vertices
  std::vector<double> thickness_;             // per vertex: see LimbSections::thickness()
  std::vector<double> ball_;                  // per vertex: how far the surface is from there
  std::vector<JointBalls> joints_;            // per vertex
  std::vector<std::vector<LimbFork>> forks_;  // per vertex
};

}  // namespace

void centre_lines(const CentreLinesInput& input, std::vector<Vec3>& places) {
  CentreLines(input, places).run();
}

}  // namespace affskel::core
