#include "core/curve/joined_links.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

constexpr double kTogether = 1.3;     // balls: up to so far from each other joints are one
constexpr double kMuchThinner = 0.5;  // of the larger ball: what hangs on that may meet just outside of it

// Vertices, the first counted twice.
constexpr std::size_t kLeastLoop = 4;

class Joints {
 public:
  Joints(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
         ExecutionContext* context)
      : stop_(context),
        lines_(lines),
        places_(places),
        ball_(ball),
        polylines_(polylines(lines.vertices.size(), lines.segments)),
        joint_(lines.vertices.size()),
        members_(lines.vertices.size()),
        ends_(line_ends(lines.vertices.size(), polylines_)),
        gone_(polylines_.size(), 0) {
    for (std::uint32_t v = 0; v < joint_.size(); ++v) {
      members_[joint_[v] = v] = {v};
      middle_ = middle_ + (1 / static_cast<double>(joint_.size())) * place(v);
    }
    for (std::uint32_t n = 0; n < polylines_.size(); ++n) {
      const std::uint32_t a = polylines_[n].front(), b = polylines_[n].back();
      if (a != b && ends_[a].size() > 2 && ends_[b].size() > 2)
        links_.push_back({length_of(polylines_[n]), n});
    }
    std::sort(links_.begin(), links_.end());
  }

  SheetLines run() {
    for (const auto& [length, n] : links_) stop_.did(10 * join(n));
    return drawn();
  }

 private:
  const Vec3& place(std::uint32_t v) const { return places_[lines_.vertices[v]]; }
  double ball(std::uint32_t v) const { return ball_[lines_.vertices[v]]; }
  // Which of two joints stays: balls, in spacings of the lattice, are often equal, and numbers would not be those of a
  // mirror image.
  std::pair<double, double> rank(std::uint32_t v) const { return {ball(v), -norm(place(v) - middle_)}; }
  double distance(std::uint32_t a, std::uint32_t b) const { return norm(place(a) - place(b)); }

  double length_of(std::span<const std::uint32_t> line) const {
    double length = 0;
    for (std::size_t k = 1; k < line.size(); ++k) length += distance(line[k - 1], line[k]);
    return length;
  }

  // Of all that have become a each with all that have become b: by one between them a trunk's two ends would be one.
  bool are_within(std::uint32_t a, std::uint32_t b, double way) const {
    for (const std::uint32_t v : members_[a])
      for (const std::uint32_t w : members_[b])
        if (distance(v, w) >= way) return false;
    return true;
  }

  // Without it its ends do not hang together.
  bool is_bridge(std::uint32_t which) {
    stop_.did(joint_.size());
    DisjointSets pieces(joint_.size());
    for (std::uint32_t n = 0; n < polylines_.size(); ++n)
      if (n != which) pieces.unite(polylines_[n].front(), polylines_[n].back());
    return pieces.find(polylines_[which].front()) != pieces.find(polylines_[which].back());
  }

  // The ends of a jar's handle, where its belly begins, are not one for lying in that.  A dog's hind legs meet just outside of its
  // trunk's ball.
  bool are_together(std::uint32_t a, std::uint32_t b, std::uint32_t link) {
    const auto [smaller, larger] = std::minmax({ball(a), ball(b)});
    const double way = (smaller < kMuchThinner * larger ? kTogether : 1) * larger;
    return are_within(a, b, kTogether * smaller) || (are_within(a, b, way) && is_bridge(link));
  }

  // The line itself, not only its ends: a handle leads from a trunk's ball back into it.
  bool lies_in_balls(std::span<const std::uint32_t> line, std::uint32_t a, std::uint32_t b) const {
    return std::all_of(line.begin(), line.end(),
                       [&](std::uint32_t v) { return distance(v, a) < ball(a) || distance(v, b) < ball(b); });
  }

  // Whether lines would lie on each other, had b become a.
  bool would_meet(std::uint32_t which, std::uint32_t a, std::uint32_t b) const {
    std::set<std::uint32_t> straight;  // where such lines from a lead
    for (const std::uint32_t joint : {a, b}) {
      for (const LineEnd& end : ends_[joint]) {
        if (end.line == which || gone_[end.line]) continue;
        const auto& line = polylines_[end.line];
        const std::uint32_t other = joint_[point_from(!end.back, line, 0)];
        if ((other == a || other == b) && line.size() < kLeastLoop) return true;
        if (line.size() == 2 && !straight.insert(other).second) return true;
      }
    }
    return false;
  }

  // @return how much it looked at.
  std::size_t join(std::uint32_t n) {
    std::uint32_t a = joint_[polylines_[n].front()], b = joint_[polylines_[n].back()];
    if (rank(b) > rank(a)) std::swap(a, b);
    const std::size_t looked_at =
        members_[a].size() * members_[b].size() + polylines_[n].size() + ends_[a].size();
    if (a == b || !lies_in_balls(polylines_[n], a, b) || would_meet(n, a, b) || !are_together(a, b, n))
      return looked_at;
    gone_[n] = 1;
    for (const std::uint32_t v : members_[b]) joint_[v] = a;
    move_all(members_[b], members_[a]);
    move_all(ends_[b], ends_[a]);
    return looked_at;
  }

  template <class Item>
  static void move_all(std::vector<Item>& from, std::vector<Item>& to) {
    to.insert(to.end(), from.begin(), from.end());
    from = {};
  }

  SheetLines drawn() const {
    std::vector<char> stays(lines_.vertices.size());
    for (std::uint32_t v = 0; v < stays.size(); ++v) stays[v] = joint_[v] == v;
    for (std::uint32_t n = 0; n < polylines_.size(); ++n)
      if (gone_[n])
        for (std::size_t k = 1; k + 1 < polylines_[n].size(); ++k) stays[polylines_[n][k]] = 0;
    std::vector<Segment> segments;
    for (std::uint32_t n = 0; n < polylines_.size(); ++n) {
      if (gone_[n]) continue;
      for (std::size_t k = 1; k < polylines_[n].size(); ++k)
        segments.push_back(ascending(joint_[polylines_[n][k - 1]], joint_[polylines_[n][k]]));
    }
    std::sort(segments.begin(), segments.end());
    return numbered_anew(lines_, stays, std::move(segments));
  }

  StopCheck stop_;
  const SheetLines& lines_;
  std::span<const Vec3> places_;
  std::span<const double> ball_;
  Vec3 middle_;                                              // of all vertices
  const std::vector<std::vector<std::uint32_t>> polylines_;  // by numbers in lines_.vertices
  std::vector<std::uint32_t> joint_;                 // per vertex: itself, or the joint that stands for it
  std::vector<std::vector<std::uint32_t>> members_;  // per joint: what it stands for
  std::vector<std::vector<LineEnd>> ends_;           // per joint: of lines, at these
  std::vector<char> gone_;                           // per polyline
  std::vector<std::pair<double, std::uint32_t>> links_;
};

}  // namespace

SheetLines joined_links(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
                        ExecutionContext* context) {
  return Joints(lines, places, ball, context).run();
}

}  // namespace affskel::core
