#include "core/curve/curve_graph.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/plain_math.h"
#include "core/base/unit.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// The direction of a branch is that of its stretch from one radius of the joint on, so many of its own radii long:
// nearer, lines bend into each other.
constexpr double kStretch = 4;

class Graph {
 public:
  Graph(std::span<const Vec3> places, std::span<const Segment> segments, std::span<const double> radius,
        std::span<const double> share)
      : places_(places), radius_(radius), share_(share), ends_(places.size(), 0) {
    for (auto& line : polylines(places.size(), segments)) add(std::move(line));
    std::vector<char> used(places.size(), 0);
    for (const CurveBranch& branch : graph_.branches)
      for (const std::uint32_t v : branch.vertices) used[v] = 1;
    for (std::uint32_t v = 0; v < used.size(); ++v)
      if (!used[v]) add({v});
  }

  CurveGraph run() {
    give_vertices();
    put_in_order();
    list_nodes();
    for (CurveBranch& branch : graph_.branches) measure(branch);
    for (std::size_t b = 0; b < graph_.branches.size(); ++b) measure_angle(b);
    return std::move(graph_);
  }

 private:
  void add(std::vector<std::uint32_t> line) {
    CurveBranch branch;
    if (line.size() > 1) {
      ++ends_[line.front()];
      ++ends_[line.back()];
    }
    branch.vertices = std::move(line);
    graph_.branches.push_back(std::move(branch));
  }

  bool is_within(const CurveBranch& branch, std::size_t n) const {
    return n > 0 && n + 1 < branch.vertices.size();
  }

  // Those within a branch are its own; then those at its ends, to the heaviest by these.
  void give_vertices() {
    std::vector<double> within(graph_.branches.size(), 0);
    graph_.part.assign(places_.size(), 0);
    std::vector<std::uint32_t> heaviest(places_.size(), std::numeric_limits<std::uint32_t>::max());
    for (std::uint32_t b = 0; b < within.size(); ++b) {
      const CurveBranch& branch = graph_.branches[b];
      for (std::size_t n = 0; n < branch.vertices.size(); ++n)
        if (is_within(branch, n)) within[b] += share_[branch.vertices[n]];
    }
    for (std::uint32_t b = 0; b < within.size(); ++b) {
      const CurveBranch& branch = graph_.branches[b];
      for (std::size_t n = 0; n < branch.vertices.size(); ++n) {
        std::uint32_t& owner = heaviest[branch.vertices[n]];
        if (is_within(branch, n) || owner == std::numeric_limits<std::uint32_t>::max() ||
            within[b] > within[owner])
          owner = b;
      }
    }
    graph_.part = std::move(heaviest);
    for (std::size_t v = 0; v < places_.size(); ++v) graph_.branches[graph_.part[v]].share += share_[v];
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
      while (end < order.size() && share(order[end]) >= CurveGraph::kAboutEqual * share(order[end - 1])) ++end;
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

  static void sort_along(std::span<std::uint32_t> branches, const std::vector<Vec3>& means) {
    std::array<double, 3> extent{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax_element(
          branches.begin(), branches.end(),
          [&](std::uint32_t a, std::uint32_t b) { return means[a][axis] < means[b][axis]; });
      extent[static_cast<std::size_t>(axis)] = means[*high][axis] - means[*low][axis];
    }
    const int axis =
        static_cast<int>(std::max_element(extent.begin(), extent.end()) - extent.begin());
    std::stable_sort(branches.begin(), branches.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return means[a][axis] < means[b][axis]; });
  }

  void list_nodes() {
    std::vector<char> within(places_.size(), 0);
    for (const CurveBranch& branch : graph_.branches)
      for (std::size_t n = 0; n < branch.vertices.size(); ++n)
        if (is_within(branch, n)) within[branch.vertices[n]] = 1;
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
    branch.least_radius = branch.greatest_radius = radius_[vertices.front()];
    double sum = 0;
    for (std::size_t n = 1; n < vertices.size(); ++n) {
      const std::uint32_t a = vertices[n - 1], b = vertices[n];
      const double length = norm(places_[b] - places_[a]);
      branch.length += length;
      sum += 0.5 * length * (radius_[a] + radius_[b]);
      branch.least_radius = std::min(branch.least_radius, radius_[b]);
      branch.greatest_radius = std::max(branch.greatest_radius, radius_[b]);
    }
    branch.mean_radius = branch.length > 0 ? sum / branch.length : branch.least_radius;
    branch.straight_length = norm(places_[vertices.back()] - places_[vertices.front()]);
  }

  // The place so far along a branch, from its first vertex or from its last.
  Vec3 place_along(const CurveBranch& branch, bool from_last, double way) const {
    const std::size_t count = branch.vertices.size();
    const auto at = [&](std::size_t n) { return places_[branch.vertices[from_last ? count - 1 - n : n]]; };
    for (std::size_t n = 1; n < count; ++n) {
      const double length = norm(at(n) - at(n - 1));
      if (way <= length && length > 0) return at(n - 1) + (way / length) * (at(n) - at(n - 1));
      way -= length;
    }
    return at(count - 1);
  }

  // Away from the end.
  Vec3 direction(const CurveBranch& branch, bool from_last) const {
    const std::uint32_t joint = from_last ? branch.vertices.back() : branch.vertices.front();
    const double begin = std::min(radius_[joint], 0.5 * branch.length);
    const double end = std::min(begin + kStretch * branch.mean_radius, branch.length);
    return unit(place_along(branch, from_last, end) - place_along(branch, from_last, begin));
  }

  void measure_angle(std::size_t which) {
    CurveBranch& branch = graph_.branches[which];
    branch.angle = std::numeric_limits<double>::quiet_NaN();
    if (branch.kind == BranchKind::kPoint || branch.kind == BranchKind::kLine) return;
    for (std::size_t b = 0; b < graph_.branches.size(); ++b) {
      const CurveBranch& other = graph_.branches[b];
      if (b == which || other.kind == BranchKind::kPoint) continue;
      if (other.from != branch.from && other.to != branch.from) continue;
      const Vec3 way = direction(branch, false), on = direction(other, other.from != branch.from);
      branch.angle = 180 / std::numbers::pi * plain_angle(norm(cross(way, on)), dot(way, on));
      return;
    }
  }

  std::span<const Vec3> places_;
  std::span<const double> radius_, share_;
  std::vector<std::uint32_t> ends_;  // of branches, per vertex
  CurveGraph graph_;
};

}  // namespace

CurveGraph curve_graph(std::span<const Vec3> places, std::span<const Segment> segments,
                       std::span<const double> radius, std::span<const double> share) {
  return Graph(places, segments, radius, share).run();
}

}  // namespace affskel::core
