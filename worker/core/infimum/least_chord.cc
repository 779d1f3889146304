// Notation.  f(t) the volume of the piece below the plane of normal d + t_0 u + t_1 w; g and H its derivatives
// at t = 0; s a saddle, z = (u.(s - x), w.(s - x)): the plane touches s where t.z = 0 and lies below it where
// t.z > 0.  At a least piece g = sum of l_i z_i over the active saddles with all l_i >= 0.
#include "core/infimum/least_chord.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/infimum/chord_piece.h"
#include "core/infimum/saddle_search.h"
#include "core/infimum/section_loops.h"
#include "core/infimum/tilt_step.h"

namespace affskel::core {
namespace {

constexpr int kMaxSteps = 60;
constexpr double kAcrossPromise = 1.2;  // DescentBound::promise
constexpr int kMaxShorter = 6;          // of a step
constexpr double kLeastGain = 1e-9;     // of the volume: a step that promises less is not made
constexpr double kMinGain = 1e-12;      // of the volume: a lesser decrease is none
constexpr double kLastGain = 1e-8;      // of the volume: after it, the next would be below rounding
constexpr double kBeyond = 1e-9;        // how far below a saddle it is tried whether a part joins there
constexpr double kJump = 1e-9;          // of the volume
constexpr double kAcross = 1e-6;        // how far below a saddle a descent across it starts
constexpr double kWorthwhile = 1.3;  // how much more than the least piece one across a saddle may be at first
constexpr double kWorth = 1e-7;      // of the least piece, by which another must be less
constexpr double kParallel = 1e-9;   // sine between two saddles' z
constexpr double kAlike = 0.98;      // cosine

}  // namespace

bool alike(const LeastChord& a, const LeastChord& b) {
  return dot(a.normal, b.normal) > kAlike;
}

double promised(const LeastChord& piece, const Vec3& way) {
  const double root = std::max(0.0, 1 + piece.slope * dot(piece.normal, way) / (3 * piece.erosion));
  return piece.erosion * root * root * root;
}

class ChordDescent::Work {
 public:
  explicit Work(const PieceInput& input) : in_(input), finder_(input), saddles_(input) {}

  LeastChord descend(const Vec3& x, const LeastChord& start, const DescentBound& bound) {
    x_ = x;
    const LeastChord least = go_down(start, bound);
    return least.erosion < bound.erosion * (1 - kLastGain) ? least : LeastChord{};
  }

  LeastChord look_across(const Vec3& x, LeastChord least) {
    x_ = x;
    while (true) {
      const LeastChord lower = across(least);
      if (!(lower.erosion < least.erosion * (1 - kLastGain))) return least;
      least = lower;
    }
  }

  std::uint64_t evaluations() const { return evaluations_; }
  SaddleSearch& saddles() { return saddles_; }

 private:
  // Where a solid overlaps itself, sections may be turned inside out.
  static bool valid(const ChordPiece& piece) { return piece.found && piece.volume > 0 && piece.area > 0; }

  ChordPiece find(const Vec3& d) {
    ++evaluations_;
    found_x_ = x_;
    found_d_ = d;
    return finder_.find(x_, d);
  }

  // Finds the piece of d again, unless it is the one found last.
  void find_again(const Vec3& d) {
    if (!(found_x_ == x_ && found_d_ == d)) find(d);
  }

  // From the plane nearest to start's that touches its saddles.
  LeastChord go_down(const LeastChord& start, const DescentBound& bound) {
    active_.clear();
    for (const std::uint32_t s : start.saddles) {
      if (s != kNone) active_.push_back(s);
    }
    return go_down(touching(start.normal), bound);
  }

  LeastChord go_down(const Vec3& from, const DescentBound& bound) {
    d_ = from;
    piece_ = {find(d_), {}};
    if (!valid(piece_) || piece_.volume > bound.first) return {};
    bent_ = false;
    for (int n = 0; n < kMaxSteps; ++n) {
      const TiltStep step = next_step();
      if (piece_.volume - bound.promise * step.gain > bound.erosion) return {};
      if (!(step.gain > kLeastGain * piece_.volume) || !go(step)) break;
    }
    return result();
  }

  // The lesser piece, if there is one, on the other side of a saddle near a least one: of those that the plane
  // touches, which a part joins there, or of those just below it, where a part is left out.
  LeastChord across(const LeastChord& least) {
    const std::vector<std::uint32_t> others = held_below(least);
    LeastChord best = least;
    const auto keep = [&](const LeastChord& other) {
      if (other.erosion < best.erosion) best = other;
    };
    for (std::size_t i = 0; i < 2; ++i) {
      if (least.saddles[i] == kNone) continue;
      active_.clear();
      if (least.saddles[1 - i] != kNone) active_.push_back(least.saddles[1 - i]);
      const Vec3 y = from_x(least.saddles[i]);
      const Vec3 d = touching(least.normal - (kAcross / dot(y, y)) * y);
      const double none = std::numeric_limits<double>::infinity();
      if (dot(d, y) < -kTouchHeight) keep(go_down(d, {none, best.erosion * (1 - kWorth), kAcrossPromise}));
    }
    for (const std::uint32_t saddle : others) {
      const Vec3 d = touch_beside(saddle, least);
      keep(go_down(d, {kWorthwhile * best.erosion, best.erosion * (1 - kWorth), kAcrossPromise}));
    }
    return best;
  }

  // The saddles just below a least plane that its piece holds: at others nothing is left out.
  std::vector<std::uint32_t> held_below(const LeastChord& least) {
    std::vector<std::uint32_t> held;
    for (const SaddleSearch::Saddle& saddle : saddles_.just_below(x_, least.normal)) {
      find_again(least.normal);
      if (finder_.holds(saddle.vertex)) held.push_back(saddle.vertex);
    }
    return held;
  }

  // The plane nearest to a least one that touches a saddle and lies above none of those that are held there: it
  // touches one of them, too, where it must.
  Vec3 touch_beside(std::uint32_t saddle, const LeastChord& least) {
    active_.assign(1, saddle);
    Vec3 best = touching(least.normal);
    if (holds(best, least)) return best;
    double nearest = -1;
    std::uint32_t second = kNone;
    for (const std::uint32_t held : least.saddles) {
      if (held == kNone) continue;
      active_ = {saddle, held};
      const Vec3 d = touching(least.normal);
      const double cosine = dot(d, least.normal);
      if (cosine <= nearest || !holds(d, least)) continue;
      nearest = cosine;
      best = d;
      second = held;
    }
    active_.assign(1, saddle);
    if (second != kNone) active_.push_back(second);
    return best;
  }

  bool holds(const Vec3& d, const LeastChord& least) const {
    return std::all_of(least.saddles.begin(), least.saddles.end(),
                       [&](std::uint32_t s) { return s == kNone || dot(d, from_x(s)) >= -kTouchHeight; });
  }

  LeastChord result() const {
    LeastChord least;
    least.erosion = piece_.volume;
    least.area = piece_.area;
    least.slope = piece_.area + multipliers();
    least.normal = d_;
    for (std::size_t i = 0; i < active_.size(); ++i) least.saddles[i] = active_[i];
    if (active_.size() == 2 && active_[1] < active_[0]) std::swap(least.saddles[0], least.saddles[1]);
    return least;
  }

  Vec3 from_x(std::uint32_t vertex) const { return in_.mesh.points[vertex] - x_; }
  Flat flat(std::uint32_t vertex) const {
    const Vec3 y = from_x(vertex);
    return {dot(piece_.u, y), dot(piece_.w, y)};
  }

  // The unit vector nearest to d of a plane that touches the active saddles.
  Vec3 touching(Vec3 d) const {
    if (active_.size() == 2) {
      const Vec3 normal = cross(from_x(active_[0]), from_x(active_[1]));
      const double size = norm(normal);
      if (size > kParallel * norm(from_x(active_[0])) * norm(from_x(active_[1]))) {
        return (dot(normal, d) < 0 ? -1 / size : 1 / size) * normal;
      }
    }
    if (!active_.empty()) {
      const Vec3 s = from_x(active_[0]);
      for (int twice = 0; twice < 2; ++twice) d = d - (dot(d, s) / dot(s, s)) * s;
    }
    return (1 / norm(d)) * d;
  }

  // The sum of the active saddles' multipliers.
  double multipliers() const {
    if (active_.empty()) return 0;
    const Flat z = flat(active_[0]);
    if (active_.size() == 1) return std::max(0.0, dot(piece_.gradient, z) / dot(z, z));
    const auto [first, second] = pair_of_multipliers(z, flat(active_[1]));
    return std::max(0.0, first) + std::max(0.0, second);
  }

  std::pair<double, double> pair_of_multipliers(const Flat& a, const Flat& b) const {
    const double det = cross(a, b);
    return {cross(piece_.gradient, b) / det, cross(a, piece_.gradient) / det};
  }

  // Lets go of saddles that hold nothing back, and steps along those that remain.
  TiltStep next_step() {
    if (active_.size() == 2) {
      const Flat a = flat(active_[0]), b = flat(active_[1]);
      if (std::abs(cross(a, b)) <= kParallel * norm(a) * norm(b)) {
        active_.pop_back();
      } else {
        const auto [first, second] = pair_of_multipliers(a, b);
        if (first >= 0 && second >= 0) return {};
        active_.erase(active_.begin() + (first * norm(a) < second * norm(b) ? 0 : 1));
      }
    }
    if (!bent_) move_to(d_, standing(piece_));
    if (active_.empty()) return free_step(piece_);
    const Flat z = flat(active_[0]);
    if (dot(piece_.gradient, z) < 0) {
      const TiltStep free = free_step(piece_);
      if (dot(free.t, z) > 0) {
        active_.clear();
        return free;
      }
    }
    return step_round(piece_, z);
  }

  Vec3 tilted(const TiltStep& step, double share) const {
    return d_ + ((share * step.t[0]) * piece_.u + (share * step.t[1]) * piece_.w);
  }

  // The piece of d is the one found last.
  Stand standing(const ChordPiece& piece) const { return {piece, finder_.hessian()}; }

  void move_to(const Vec3& d, const Stand& piece) {
    d_ = d;
    piece_ = piece;
    bent_ = true;
  }

  bool falls(const ChordPiece& piece) const {
    return valid(piece) && piece.volume < piece_.volume * (1 - kMinGain);
  }

  // Makes the step, or as much of it as lets f fall; false when none does.
  bool go(const TiltStep& step) {
    const Vec3 end = touching(tilted(step, 1));
    const ChordPiece there = find(end);
    if (falls(there)) {
      move_to(end, {there, {}});
      bent_ = false;
      return true;
    }
    meetings_ = saddles_.sinking(x_, d_, tilted(step, 1), active_);
    return go_to_meeting(step, there);
  }

  // f is smooth up to `share` of the step, and does not fall as far as there.
  bool go_shorter(const TiltStep& step, double share, const ChordPiece& end) {
    if (step.gain < kLastGain * piece_.volume) return false;
    ChordPiece there = end;
    for (int n = 0; n < kMaxShorter; ++n) {
      share *= shorter(step, share, there);
      const Vec3 d = touching(tilted(step, share));
      there = find(d);
      if (!falls(there)) continue;
      move_to(d, standing(there));
      return true;
    }
    return false;
  }

  // The least of the parabola through f and its slope here and f there, as a share of the way.
  double shorter(const TiltStep& step, double share, const ChordPiece& there) const {
    if (!valid(there)) return 0.25;
    const double slope = share * dot(piece_.gradient, step.t);
    const double rise = there.volume - piece_.volume - slope;
    return rise > 0 ? std::clamp(-0.5 * slope / rise, 0.05, 0.5) : 0.5;
  }

  // How many of the meetings lie where the plane is now, within rounding.
  std::size_t meetings_here(const TiltStep& step) const {
    const double fall = -dot(piece_.gradient, step.t);
    std::size_t here = 0;
    while (here < meetings_.size() && meetings_[here].at * fall <= kLastGain * piece_.volume) ++here;
    return here;
  }

  bool go_to_meeting(const TiltStep& step, const ChordPiece& end) {
    const std::size_t here = meetings_here(step);
    std::size_t falling = here, rising = meetings_.size();  // how many are passed
    Vec3 best;
    Stand best_piece;
    ChordPiece first_piece;
    while (falling < rising) {
      const std::size_t middle = falling + (rising - falling + 1) / 2;
      const SaddleSearch::Saddle& meeting = meetings_[middle - 1];
      active_.push_back(meeting.vertex);
      const Vec3 d = touching(tilted(step, meeting.at));
      active_.pop_back();
      const ChordPiece there = find(d);
      if (falls(there)) {
        falling = middle;
        best = d;
        best_piece = standing(there);
      } else {
        rising = middle - 1;
        first_piece = there;
      }
    }
    if (falling == here) {
      for (std::size_t n = 0; n < here; ++n) {
        if (hold(meetings_[n].vertex)) return true;
      }
      return here < meetings_.size() ? go_shorter(step, meetings_[here].at, first_piece)
                                     : go_shorter(step, 1, end);
    }
    move_to(best, best_piece);
    if (joins_at(meetings_[falling - 1].vertex)) active_.push_back(meetings_[falling - 1].vertex);
    return true;
  }

  // Whether a part joins the piece as soon as the plane passes the vertex, which it touches.
  bool joins_at(std::uint32_t vertex) {
    find_again(d_);
    const PieceFinder::Joins joins = finder_.joins_at(vertex);
    if (joins != PieceFinder::Joins::unknown) return joins == PieceFinder::Joins::yes;
    const Vec3 s = from_x(vertex);
    const Vec3 d = d_ - (kBeyond / dot(s, s)) * s;
    const ChordPiece beyond = find((1 / norm(d)) * d);
    const double smooth = kBeyond / norm(s) * norm(piece_.gradient);
    return valid(beyond) && beyond.volume > piece_.volume * (1 + kJump) + 2 * smooth;
  }

  // Makes a saddle active that the plane touches within rounding; false where nothing joins there.
  bool hold(std::uint32_t vertex) {
    const Vec3 old = d_;
    const Stand old_piece = piece_;
    active_.push_back(vertex);
    d_ = touching(d_);
    piece_ = standing(find(d_));
    if (valid(piece_) && piece_.volume <= old_piece.volume * (1 + kJump) && joins_at(vertex)) return true;
    active_.pop_back();
    move_to(old, old_piece);
    return false;
  }

  const PieceInput& in_;
  PieceFinder finder_;
  SaddleSearch saddles_;
  Vec3 x_, d_, found_x_, found_d_;                  // the last two: of the piece found last
  std::vector<std::uint32_t> active_;               // saddles, at most two
  Stand piece_;                                     // of d_
  bool bent_ = false;                               // whether that knows its second derivatives
  std::span<const SaddleSearch::Saddle> meetings_;  // of the step in hand
  std::uint64_t evaluations_ = 0;
};

ChordDescent::ChordDescent(const PieceInput& input) : work_(std::make_unique<Work>(input)) {}
ChordDescent::~ChordDescent() = default;

LeastChord ChordDescent::descend(const Vec3& x, const LeastChord& start, const DescentBound& bound) {
  return work_->descend(x, start, bound);
}

LeastChord ChordDescent::look_across(const Vec3& x, LeastChord least) {
  return work_->look_across(x, least);
}

SaddleSearch& ChordDescent::saddles() {
  return work_->saddles();
}

std::uint64_t ChordDescent::evaluations() const {
  return work_->evaluations();
}

}  // namespace affskel::core
