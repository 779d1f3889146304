#include "core/collapse/limb_tips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <utility>

#include "core/base/none.h"
#include "core/base/unit.h"
#include "core/base/vec3.h"
#include "core/collapse/collapsing.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

// A line leads out of the middle of a blunt end, not along a limb, while births grow by so much of its length:
// by 1 towards the middle of a ball, 0.58 from the corner of a box, 0.71 along the bisector of a plate's.
constexpr double kSteep = 0.5;

// Shorter lines are steps of the lattice, spacings.
constexpr double kMinLength = 4;

constexpr double kWalk = 0.5;  // spacings: steps on the way to the middle of an end

// What is so many times as long as wide has begun to be a limb: where births grow fast from there on, it comes to what it
// grows from.  Twigs that fork were lost there.
constexpr double kBegun = 0.5;

// A line that comes to another's, and is so many times as long, is from another corner of the same end.
constexpr double kSameEnd = 0.5;

// A corner of a flat end lies so many times as far from its middle as from the surface.
constexpr double kFlat = 2.5;

// Eats lone edges from the ends of their lines.
class LineThinning {
 public:
  // @param cut_ends vertices of edges that are cut; `cuts` are to be taken out once they have no coface.
  LineThinning(ThinnedSolid& solid, double least_reach, std::set<Cell> cut_ends, std::span<const Cell> cuts)
      : complex_(*solid.complex),
        solid_(solid),
        least_reach_(least_reach),
        cut_ends_(std::move(cut_ends)),
        cuts_(cuts.begin(), cuts.end()),
        line_at_(complex_, DualComplex::places_of_dimension(0), DualComplex::kNone) {}

  std::vector<LimbTip> tips() {
    for (const Line& line : lines_) keep_tip(line);
    std::sort(tips_.begin(), tips_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<LimbTip> result;
    for (const auto& [begun, tip] : tips_) result.push_back(tip);
    return result;
  }

  // Marks where the front has passed already.  Where a closed surface is cut, its squares go, too.
  Collapsing::Due due(Cell cell, Cell coface, double now) {
    const bool is_line = DualComplex::dimension(coface) == 1;
    if (!is_line) solid_.fronts.stands_at(cell);
    const bool passed = solid_.fronts.is_passed(cell, coface);
    const double came_to = is_line ? solid_.freed_at(cell) : solid_.radius_at(cell);
    return {std::max(now, came_to) + (passed ? 0 : 1), passed};
  }

  double level(Cell cell) const { return solid_.level(cell); }

  void lost_coface(Cell cell, std::uint32_t left, double) {
    if (left == 0 && !cuts_.empty() && cuts_.contains(cell)) bared_cuts_.push_back(cell);
  }

  void wave_ends() {
    solid_.fronts.end_wave();
    meet();
  }

  std::optional<Cell> next_cut() {
    if (bared_cuts_.empty()) return std::nullopt;
    const Cell cut = bared_cuts_.back();
    bared_cuts_.pop_back();
    return cut;
  }

  // A lone edge goes with the vertex at its end: the line's end moves on to its other vertex.
  void removed(Cell vertex, Cell edge, double now, bool passed) {
    if (DualComplex::dimension(edge) == 2) return solid_.cross(vertex, edge, passed);
    const auto birth = static_cast<double>(solid_.fronts.reached(edge));
    const std::uint32_t number = line_ending_at(vertex, birth);
    Line& line = lines_[number];
    const double before = line.length();
    const Cell end = line.go(complex_, edge, vertex, now);
    const double length = line.length(), step = passed ? 0 : length - before;
    const double eaten = std::max(static_cast<double>(solid_.bared[vertex]), birth) + step;
    float& bared_at_end = solid_.bared[end];
    bared_at_end = std::max(bared_at_end, static_cast<float>(eaten));
    if (line.begun || !begins_at(end, birth, length, line)) {
      const double way = std::min(length - line.tip_at, eaten - birth);
      line.longest = std::max(line.longest, way);
      line.reach = std::max(line.reach, way / std::max(birth - 1, kMinLength));
      line.begun = line.begun || way >= std::max(kBegun * (birth - 1), kMinLength);
    }
    arrived_.emplace_back(end, number);
  }

 private:
  // What was eaten of a line.  Its length is measured in chords of a few edges, since edges turn with the
  // lattice's axes.  There is one for every fifth cube of a thin solid.
  struct Line {
    static constexpr double kChord = 4;

    Cell tip = 0, root = 0;  // see LimbTip
    double width = 0;        // at the root: its birth
    double reach = 0, longest = 0;
    double rise = 0;    // at the tip: by how much the radius is ahead of a steep line's
    double tip_at = 0;  // length before the root
    double whole = 0;   // of the chords
    Cell edge = 0;      // along which it came to its end
    float time = 0;     // when
    bool upwards = false, begun = false, is_cut = false;
    std::array<std::int8_t, 3> chord{};
    // From where it has come to: its root, its tip, and the sum of the tips of other lines of the same end.
    std::array<int, 3> root_place{}, tip_place{}, others{};
    int lines = 0;            // these
    std::uint32_t order = 0;  // of those that begin

    double length() const {
      return whole + std::sqrt(chord[0] * chord[0] + chord[1] * chord[1] + chord[2] * chord[2]);
    }
    // At the root: by how much births are ahead of a steep line's.
    double lead() const { return width - kSteep * tip_at; }
    // Goes along an edge from one of its ends. @return the other one.
    Cell go(const DualComplex& complex, Cell along, Cell from, double now) {
      edge = along;
      time = static_cast<float>(now);
      if (length() - whole >= kChord) {
        whole = length();
        chord = {};
      }
      std::size_t axis = 0;
      while (DualComplex::digit(DualComplex::place_of(edge), axis) != 1) ++axis;
      const auto [lower, upper] = complex.ends(edge);
      upwards = lower == from;
      const int step = upwards ? 1 : -1;
      chord[axis] = static_cast<std::int8_t>(chord[axis] + step);
      root_place[axis] -= step;
      tip_place[axis] -= step;
      others[axis] -= lines * step;
      return upwards ? upper : lower;
    }
  };

  // Whether the limb of a line begins where that has come to.
  bool begins_at(Cell end, double birth, double length, Line& line) const {
    const double fall = kSteep * length, radius = solid_.radius_at(end);
    if (radius - fall > line.rise) {
      line.tip = end;
      line.rise = radius - fall;
      line.tip_place = line.others = {};
      line.lines = 0;
    }
    if (birth - fall <= line.lead()) return false;
    line.root = end;
    line.root_place = {};
    line.width = birth;
    line.reach = line.longest = 0;
    line.tip_at = length;
    return true;
  }

  // The line whose end a vertex is, which begins there if there is none.
  std::uint32_t line_ending_at(Cell vertex, double birth) {
    const std::uint32_t number = std::exchange(line_at_[vertex], DualComplex::kNone);
    const bool is_cut = !cut_ends_.empty() && cut_ends_.contains(vertex);
    if (number == DualComplex::kNone) {
      return put({.tip = vertex,
                  .root = vertex,
                  .width = birth,
                  .rise = solid_.radius_at(vertex),
                  .is_cut = is_cut,
                  .order = begun_++});
    }
    if (is_cut) lead_from_cut(lines_[number]);
    return number;
  }

  // What is a limb without the cut stays one.
  void lead_from_cut(Line& line) const { line.is_cut = line.is_cut || line.reach < least_reach_; }

  // Where a line that is through has left its place, if one has: hardly one in ten is under way at a time.
  std::uint32_t put(const Line& line) {
    if (free_.empty()) {
      lines_.push_back(line);
      return static_cast<std::uint32_t>(lines_.size() - 1);
    }
    const std::uint32_t number = free_.back();
    free_.pop_back();
    lines_[number] = line;
    return number;
  }

  void finish(std::uint32_t number) {
    keep_tip(lines_[number]);
    lines_[number].reach = 0;
    free_.push_back(number);
  }

  void keep_tip(const Line& line) {
    if (line.reach < least_reach_) return;
    tips_.emplace_back(line.order, LimbTip{.vertex = tip_of(line),
                                           .radius = solid_.radius_at(line.root),
                                           .width = line.width,
                                           .reach = line.reach,
                                           .length = line.longest,
                                           .is_cut = line.is_cut});
  }

  // Of a flat end, whose corners lie far from its middle, the tip is in the middle.
  Cell tip_of(const Line& line) const {
    const Cell corner = line.tip;
    if (line.lines == 0) return corner;
    Vec3 way, aside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double middle = static_cast<double>(line.tip_place[axis] + line.others[axis]) / (1 + line.lines);
      way[axis] = middle - line.root_place[axis];
      aside[axis] = middle - line.tip_place[axis];
    }
    const std::optional<Cell> middle = middle_of_end(line.root, way);
    return middle && norm(aside) > kFlat * solid_.radius_at(*middle) ? *middle : corner;
  }

  // On the straight way from the root to the middle of the tips of a limb's lines, and on from there as far as the distance
  // to the surface does not fall fast; none where the solid bends away from it.
  std::optional<Cell> middle_of_end(Cell root, const Vec3& way) const {
    const double length = norm(way);
    Cell best = root;
    std::optional<Cell> here = root;
    std::array<int, 3> at{};
    double most = 0;
    for (double gone = 0; length > 0; gone += kWalk) {
      here = stepped(*here, gone / length * way, at);
      if (!here) {
        if (gone <= length) return std::nullopt;
        break;
      }
      const double value = solid_.radius_at(*here) + kSteep * gone;
      if (gone > length && value < most) break;
      most = std::max(most, value);
      best = *here;
    }
    return best;
  }

  // The vertex at a place, spacings from where `at` counts from, or none.
  std::optional<Cell> stepped(Cell vertex, const Vec3& place, std::array<int, 3>& at) const {
    std::optional<Cell> here = vertex;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int to = static_cast<int>(std::lround(place[axis]));
      for (; at[axis] != to && here; at[axis] += at[axis] < to ? 1 : -1)
        here = complex_.next_vertex(*here, axis, at[axis] < to);
    }
    return here;
  }

  // Of several lines that meet at a vertex the last goes on; of those that come at once, in any order, the one from the
  // highest.
  void meet() {
    std::ranges::sort(arrived_);
    for (auto first = arrived_.begin(), next = first; first != arrived_.end(); first = next) {
      const Cell end = first->first;
      next = std::find_if(first, arrived_.end(), [&](const auto& arrival) { return arrival.first != end; });
      const std::uint32_t last = std::max_element(first, next, [&](const auto& a, const auto& b) {
                                   return is_later(lines_[b.second], lines_[a.second]);
                                 })->second;
      if (const std::uint32_t before = std::exchange(line_at_[end], last); before != DualComplex::kNone)
        join(before, lines_[last]);
      for (; first != next; ++first)
        if (first->second != last) join(first->second, lines_[last]);
    }
    arrived_.clear();
  }

  // One that ends where another goes on.
  void join(std::uint32_t number, Line& line) {
    const Line& other = lines_[number];
    if (other.is_cut) lead_from_cut(line);
    if (!line.begun && !other.begun && other.length() >= kSameEnd * line.length()) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        line.others[axis] += other.tip_place[axis] + other.others[axis];
      line.lines += 1 + other.lines;
    }
    finish(number);
  }
  bool is_later(const Line& line, const Line& than) const {
    const auto rank = [&](const Line& of) {
      const Cell from = complex_.ends(of.edge)[of.upwards ? 0 : 1];
      return CellRank(complex_, level(from) + level(of.edge), from);
    };
    return line.time > than.time || rank(than) < rank(line);
  }

  const DualComplex& complex_;
  ThinnedSolid& solid_;
  double least_reach_;
  std::set<Cell> cut_ends_;
  std::set<Cell> cuts_;
  std::vector<Cell> bared_cuts_;
  std::vector<std::pair<Cell, std::uint32_t>> arrived_;  // in this wave: at which vertex, and which line
  std::deque<Line> lines_;                               // under way, and places that are free
  std::vector<std::uint32_t> free_;
  std::uint32_t begun_ = 0;
  std::vector<std::pair<std::uint32_t, LimbTip>> tips_;  // by which line
  CellValues<std::uint32_t> line_at_;                    // per vertex at the end of a line
};

}  // namespace

LimbTips limb_tips(ThinnedSolid solid, double least_reach, std::span<const Cell> cuts,
                   ExecutionContext* context) {
  const DualComplex& complex = *solid.complex;
  std::set<Cell> ends;
  std::vector<Cell> covered;  // cuts that are bared later
  for (const int dimension : {2, 1}) {
    for (const Cell cut : cuts) {
      if (DualComplex::dimension(cut) != dimension) continue;
      if (!is_bare(complex, cut, solid.cells)) {
        covered.push_back(cut);
        continue;
      }
      solid.cells.erase(cut);
      if (dimension == 2) continue;
      complex.for_each_face(cut, [&](Cell end) {
        solid.note_freed(end, static_cast<double>(solid.fronts.reached(cut)));
        ends.insert(end);
      });
    }
  }
  // What is not needed any more goes: memory is tight here.
  Collapsing collapsing = [&] {
    const CellSet cells = std::move(solid.cells);
    return Collapsing(complex, cells, context);
  }();
  std::vector<LimbTip> tips;
  {
    LineThinning thinning(solid, least_reach, std::move(ends), covered);
    collapsing.run(thinning);
    tips = thinning.tips();
  }
  return {std::move(tips), collapsing.cells()};
}

}  // namespace affskel::core
