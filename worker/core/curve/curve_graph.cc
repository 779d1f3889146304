#include "core/curve/curve_graph.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/groups.h"
#include "core/base/none.h"
#include "core/base/plain_math.h"
#include "core/base/unit.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// The direction of a branch is that of its stretch from one radius of the joint on, at most so many of its own radii long:
// nearer, lines bend into each other.  Where it bends that is shorter, until its ends are as far apart as kAboutStraight of it.
constexpr double kStretch = 4, kLeastStretch = 1, kAboutStraight = 0.995;

// Of the extent of some branches: what is nearer to each other has no order along that axis.
constexpr double kCloseTogether = 0.1;

class GraphOfCurve {
 public:
  GraphOfCurve(std::span<const Vec3> places, std::span<const Segment> segments,
               std::span<const double> radius, std::span<const double> share)
      : places_(places), radius_(radius), share_(share) {
    auto lines = polylines(places.size(), segments);
    ends_ = ends_of(places.size(), lines);
    for (auto& line : lines) add(std::move(line));
    std::vector<char> used(places.size(), 0);
    for (const CurveBranch& branch : graph_.branches)
      for (const std::uint32_t v : branch.vertices) used[v] = 1;
    for (std::uint32_t v = 0; v < used.size(); ++v)
      if (!used[v] || is_body(v)) add({v});
  }

  CurveGraph run() {
    give_vertices();
    put_in_order();
    list_nodes();
    for (CurveBranch& branch : graph_.branches) measure(branch);
    const auto count = static_cast<std::uint32_t>(graph_.branches.size());
    at_vertex_ = {places_.size(), [&](const auto& put) {
                    for (std::uint32_t b = 0; b < count; ++b)
                      if (const auto& line = graph_.branches[b].vertices; line.size() > 1)
                        for (const std::uint32_t v : {line.front(), line.back()}) put(v, b);
                  }};
    for (std::uint32_t b = 0; b < count; ++b) turn_link(b);
    for (std::uint32_t b = 0; b < count; ++b) measure_angle(b);
    return std::move(graph_);
  }

 private:
  void add(std::vector<std::uint32_t> line) {
    CurveBranch branch;
    branch.vertices = std::move(line);
    graph_.branches.push_back(std::move(branch));
  }

  // See limb_hubs(): any other joint has nothing.
  bool is_body(std::uint32_t v) const { return ends_[v] > 2 && share_[v] > 0; }

  bool is_within(const CurveBranch& branch, std::size_t n) const {
    return n > 0 && n + 1 < branch.vertices.size();
  }

  // Where branches meet the heaviest has the vertex, and what of the others from there on has no share.
  void give_vertices() {
    std::vector<double> within(graph_.branches.size(), 0);
    graph_.part.assign(places_.size(), kNone);
    for_each_vertex([&](std::uint32_t b, std::uint32_t v, bool inner) {
      if (!inner) return;
      within[b] += share_[v];
      graph_.part[v] = b;
    });
    for_each_vertex([&](std::uint32_t b, std::uint32_t v, bool inner) {
      if (inner) return;
      std::uint32_t& owner = graph_.part[v];
      if (owner == kNone || graph_.branches[b].vertices.size() == 1 || within[b] > within[owner]) owner = b;
    });
    const std::vector<std::uint32_t> owner = graph_.part;
    for (std::uint32_t b = 0; b < graph_.branches.size(); ++b)
      for (const bool from_last : {false, true}) give_joint(b, from_last, owner);
    while (give_bodies()) continue;
    for (std::size_t v = 0; v < places_.size(); ++v) graph_.branches[graph_.part[v]].share += share_[v];
  }

  void give_joint(std::uint32_t b, bool from_last, std::span<const std::uint32_t> owner) {
    const auto& vertices = graph_.branches[b].vertices;
    const auto at = [&](std::size_t n) { return point_from(from_last, vertices, n); };
    if (ends_[at(0)] < 3) return;
    for (std::size_t n = 1; n + 1 < vertices.size() && share_[at(n)] == 0; ++n)
      graph_.part[at(n)] = owner[at(0)];
  }

  // What hangs together with a body and has nothing lies in it.  @return whether there was any.
  bool give_bodies() {
    const auto is_point = [&](std::uint32_t v) {
      return graph_.branches[graph_.part[v]].vertices.size() == 1;
    };
    bool any = false;
    const auto give = [&](std::uint32_t from, std::uint32_t to) {
      if (!is_point(from) || is_point(to) || share_[to] > 0) return;
      graph_.part[to] = graph_.part[from];
      any = true;
    };
    for (const CurveBranch& branch : graph_.branches) {
      const auto& line = branch.vertices;
      for (std::size_t n = 1; n < line.size(); ++n) give(line[n - 1], line[n]);
      for (std::size_t n = line.size(); n-- > 1;) give(line[n], line[n - 1]);
    }
    return any;
  }

  template <class Visit>
  void for_each_vertex(const Visit& visit) const {
    for (std::uint32_t b = 0; b < graph_.branches.size(); ++b)
      for (std::size_t n = 0; n < graph_.branches[b].vertices.size(); ++n)
        visit(b, graph_.branches[b].vertices[n], is_within(graph_.branches[b], n));
  }

  Vec3 mean_place(const CurveBranch& branch) const {
    Vec3 sum;
    for (const std::uint32_t v : branch.vertices) sum = sum + places_[v];
    return (1 / static_cast<double>(branch.vertices.size())) * sum;
  }

  void put_in_order() {
    std::vector<std::uint32_t> order(graph_.branches.size());
    for (std::uint32_t b = 0; b < order.size(); ++b) order[b] = b;
    std::vector<Vec3> means;
    for (const CurveBranch& branch : graph_.branches) means.push_back(mean_place(branch));
    const auto share = [&](std::uint32_t b) { return graph_.branches[b].share; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return share(a) > share(b); });
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      end = begin + 1;
      while (end < order.size() && share(order[end]) >= CurveGraph::kAboutEqual * share(order[end - 1]))
        ++end;
      sort_along(std::span(order).subspan(begin, end - begin), means);
    }
    std::vector<CurveBranch> sorted;
    std::vector<std::uint32_t> number(order.size());
    for (std::uint32_t n = 0; n < order.size(); ++n) {
      number[order[n]] = n;
      sorted.push_back(std::move(graph_.branches[order[n]]));
    }
    graph_.branches = std::move(sorted);
    for (std::uint32_t& part : graph_.part) part = number[part];
  }

  // Along the axis in which they are farthest apart; what is close together there, along its own.
  static void sort_along(std::span<std::uint32_t> branches, const std::vector<Vec3>& means) {
    int axis = 0;
    double extent = 0;
    for (int a = 0; a < 3; ++a) {
      const auto [low, high] =
          std::minmax_element(branches.begin(), branches.end(),
                              [&](std::uint32_t p, std::uint32_t q) { return means[p][a] < means[q][a]; });
      if (means[*high][a] - means[*low][a] <= extent) continue;
      extent = means[*high][a] - means[*low][a];
      axis = a;
    }
    std::stable_sort(branches.begin(), branches.end(),
                     [&](std::uint32_t p, std::uint32_t q) { return means[p][axis] < means[q][axis]; });
    for (std::size_t begin = 0, end = 0; begin < branches.size(); begin = end) {
      end = begin + 1;
      while (end < branches.size() &&
             means[branches[end]][axis] - means[branches[end - 1]][axis] < kCloseTogether * extent)
        ++end;
      if (end - begin > 1 && end - begin < branches.size())
        sort_along(branches.subspan(begin, end - begin), means);
    }
  }

  void list_nodes() {
    std::vector<char> within(places_.size(), 0);
    for_each_vertex([&](std::uint32_t, std::uint32_t v, bool inner) {
      if (inner) within[v] = 1;
    });
    for (std::uint32_t v = 0; v < within.size(); ++v) {
      if (within[v]) continue;
      graph_.nodes.push_back(v);
      graph_.degree.push_back(ends_[v]);
    }
  }

  std::uint32_t node(std::uint32_t v) const {
    return static_cast<std::uint32_t>(std::lower_bound(graph_.nodes.begin(), graph_.nodes.end(), v) -
                                      graph_.nodes.begin());
  }

  static BranchKind kind_of(const CurveBranch& branch, bool first_free, bool last_free) {
    if (branch.vertices.size() == 1) return BranchKind::kPoint;
    if (branch.vertices.front() == branch.vertices.back()) return BranchKind::kLoop;
    if (first_free && last_free) return BranchKind::kLine;
    return first_free || last_free ? BranchKind::kLimb : BranchKind::kLink;
  }

  void measure(CurveBranch& branch) const {
    auto& vertices = branch.vertices;
    const bool first_free = ends_[vertices.front()] == 1, last_free = ends_[vertices.back()] == 1;
    branch.kind = kind_of(branch, first_free, last_free);
    if (first_free && !last_free) std::reverse(vertices.begin(), vertices.end());
    branch.from = node(vertices.front());
    branch.to = node(vertices.back());
    const auto line = outside_bodies(branch);
    branch.length = length_of(places_, line);
    branch.straight_length = norm(places_[line.back()] - places_[line.front()]);
    measure_radius(branch);
  }

  // Within a body lines run as they please.  All of a branch that has less than two vertices elsewhere.
  std::span<const std::uint32_t> outside_bodies(const CurveBranch& branch) const {
    const std::span<const std::uint32_t> vertices = branch.vertices;
    const auto is_elsewhere = [&](std::uint32_t v) {
      const CurveBranch& owner = graph_.branches[graph_.part[v]];
      return &owner == &branch || owner.vertices.size() > 1;
    };
    const auto last = std::find_if(vertices.rbegin(), vertices.rend(), is_elsewhere).base();
    const auto first = std::find_if(vertices.begin(), last, is_elsewhere);
    return last - first > 1 ? std::span(first, last) : vertices;
  }

  void measure_radius(CurveBranch& branch) const {
    const auto& vertices = branch.vertices;
    const auto number = static_cast<std::uint32_t>(&branch - graph_.branches.data());
    const auto is_own = [&](std::uint32_t v) {  // a joint is as thick as all its limbs
      return graph_.part[v] == number && (ends_[v] < 3 || vertices.size() == 1);
    };
    const bool has_own = std::any_of(vertices.begin(), vertices.end(), is_own);
    double sum = 0, length = 0;
    branch.least_radius = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < vertices.size(); ++n) {
      const std::uint32_t v = vertices[n];
      if (has_own && !is_own(v)) continue;
      double around = vertices.size() == 1 ? 1 : 0;
      if (n > 0) around += norm(places_[v] - places_[vertices[n - 1]]);
      if (n + 1 < vertices.size()) around += norm(places_[v] - places_[vertices[n + 1]]);
      sum += around * radius_[v];
      length += around;
      branch.least_radius = std::min(branch.least_radius, radius_[v]);
      branch.greatest_radius = std::max(branch.greatest_radius, radius_[v]);
    }
    branch.mean_radius = length > 0 ? sum / length : branch.least_radius;
  }

  // Away from the end, from where the branch leaves the joint's thickness; of a body it begins there.
  Vec3 direction(const CurveBranch& branch, bool from_last) const {
    const std::uint32_t joint = from_last ? branch.vertices.back() : branch.vertices.front();
    const double begin = is_body(joint) ? 0 : std::min(radius_[joint], 0.5 * branch.length);
    const auto line = outside_bodies(branch);
    const Vec3 first = place_along(places_, line, from_last, begin);
    const auto to = [&](double way) { return place_along(places_, line, from_last, begin + way) - first; };
    double stretch = std::min(kStretch * branch.mean_radius, branch.length - begin);
    const double least = std::min(kLeastStretch * branch.mean_radius, stretch);
    while (stretch > least && norm(to(stretch)) < kAboutStraight * stretch)
      stretch = std::max(0.9 * stretch, least);
    return unit(to(stretch));
  }

  // The first other branch at an end.
  std::uint32_t beside(std::uint32_t which, std::uint32_t vertex) const {
    const auto at = at_vertex_[vertex];
    const auto other = std::find_if(at.begin(), at.end(), [&](std::uint32_t b) { return b != which; });
    return other == at.end() ? kNone : *other;
  }

  // The heaviest other branch at an end; of those as heavy the first.
  std::uint32_t heaviest_beside(std::uint32_t which, std::uint32_t vertex) const {
    std::uint32_t heaviest = kNone;
    for (const std::uint32_t b : at_vertex_[vertex])
      if (b != which && (heaviest == kNone || graph_.branches[b].share > graph_.branches[heaviest].share))
        heaviest = b;
    return heaviest;
  }

  // From the heavier of its two joints.
  void turn_link(std::uint32_t which) {
    CurveBranch& branch = graph_.branches[which];
    if (branch.kind != BranchKind::kLink) return;
    if (beside(which, branch.vertices.back()) >= beside(which, branch.vertices.front())) return;
    std::reverse(branch.vertices.begin(), branch.vertices.end());
    std::swap(branch.from, branch.to);
  }

  void measure_angle(std::uint32_t which) {
    CurveBranch& branch = graph_.branches[which];
    branch.angle = std::numeric_limits<double>::quiet_NaN();
    const std::uint32_t other = heaviest_beside(which, branch.vertices.front());
    if (other == kNone || branch.kind == BranchKind::kPoint) return;
    branch.angle_to = other;
    const CurveBranch& on = graph_.branches[other];
    const Vec3 way = direction(branch, false), rest = direction(on, on.from != branch.from);
    branch.angle = 180 / std::numbers::pi * plain_angle(norm(cross(way, rest)), dot(way, rest));
  }

  std::span<const Vec3> places_;
  std::span<const double> radius_, share_;
  std::vector<std::uint32_t> ends_;  // of branches, per vertex
  Groups<std::uint32_t> at_vertex_;  // branches that begin or end there, in their order
  CurveGraph graph_;
};

}  // namespace

CurveGraph curve_graph(std::span<const Vec3> places, std::span<const Segment> segments,
                       std::span<const double> radius, std::span<const double> share) {
  return GraphOfCurve(places, segments, radius, share).run();
}

}  // namespace affskel::core
