#include "core/curve/sheet_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "core/base/cheapest_ways.h"
#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/base/parity_rows.h"
#include "core/curve/burn_times.h"
#include "core/curve/sheet_edges.h"

namespace affskel::core {
namespace {

// Lines lead straight away from the rim: of two triangles as far from it, the farther from where lines begin goes
// first.
constexpr double kStraight = 0.1;

class Collapse {
 public:
  Collapse(const Collapse&) = delete;  // members refer to others
  Collapse(const SheetMesh& sheet, std::span<const char> ends, ExecutionContext* context)
      : sheet_(sheet),
        context_(context),
        pieces_(sheet.vertices.size()),
        stays_(ends.begin(), ends.end()),
        all_(sheet),
        edge_left_(edges_.size(), 1),
        triangles_left_(sheet.triangles.size(), 1) {
    count_edges();
    keep_centres();
  }

  SheetLines run() {
    while (true) {
      eat_sheets();
      if (!open_closed_ones()) break;
    }
    drop_centres_on_loops();
    return lines();
  }

 private:
  void count_edges() {
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      cofaces_.push_back(static_cast<std::uint32_t>(triangles_of_[e].size()));
    for (std::uint32_t v = 0; v < sheet_.vertices.size(); ++v)
      edges_at_.push_back(static_cast<std::uint32_t>(edges_round_[v].size()));
    for (const auto& [a, b] : edges_) pieces_.unite(a, b);
  }

  // The vertex of the greatest E in each piece that has less than two ends, or where a line through it ends beyond it.
  void keep_centres() {
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> pieces;  // number of ends, centre
    for (std::uint32_t v = 0; v < stays_.size(); ++v) {
      const auto [known, fresh] = pieces.try_emplace(pieces_.find(v), 0, v);
      auto& [count, centre] = known->second;
      count += stays_[v] != 0;
      if (sheet_.vertices[v].erosion > sheet_.vertices[centre].erosion) centre = v;
    }
    for (const auto& [piece, known] : pieces) {
      const auto& [count, centre] = known;
      if (count > 1 || stays_[centre]) continue;
      const std::uint32_t kept = count == 1 ? free_end_beyond(centre) : centre;
      stays_[kept] = 1;
      centres_.push_back(kept);
    }
  }

  // Where a line from a vertex ends that is no end of a limb; the vertex itself where none does.
  std::uint32_t free_end_beyond(std::uint32_t centre) const {
    if (edges_round_[centre].size() > 2) return centre;
    for (const std::uint32_t first : edges_round_[centre]) {
      std::uint32_t edge = first, v = all_.other_end(edge, centre);
      while (cofaces_[edge] == 0 && !stays_[v] && edges_round_[v].size() == 2) {
        edge = edges_round_[v][edges_round_[v][0] == edge ? 1 : 0];
        v = all_.other_end(edge, v);
        if (v == centre) return centre;
      }
      if (cofaces_[edge] == 0 && !stays_[v] && edges_round_[v].size() == 1) return v;
    }
    return centre;
  }

  // Per corner of a triangle: when it is eaten.
  std::vector<double> times() const {
    std::vector<double> result = burn_times(sheet_, all_, triangles_left_, context_);
    CheapestWays ways(starts_of_lines());
    StopCheck stop(context_);
    ways.find([&](std::uint32_t v, const auto& go) {
      stop.did(20);
      const Vec3& at = sheet_.vertices[v].position;
      for (const std::uint32_t t : all_.about[v]) {
        if (!triangles_left_[t]) continue;
        for_each_step(sheet_, all_, triangles_left_, t, v, [&](std::uint32_t to, std::uint32_t) {
          go(to, norm(at - sheet_.vertices[to].position), v);
        });
      }
    });
    for (std::size_t t = 0; t < sheet_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (const double way = ways.cost[sheet_.triangles[t][k]]; std::isfinite(way))
          result[3 * t + k] -= kStraight * way;
    return result;
  }

  // Per vertex: itself where it is an end, or a line meets a sheet, else kNone.
  std::vector<std::uint32_t> starts_of_lines() const {
    std::vector<char> is_start(stays_), on_sheet(stays_.size(), 0);
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      if (!edge_left_[e]) continue;
      for (const std::uint32_t v : edges_[e]) (cofaces_[e] > 0 ? on_sheet : is_start)[v] = 1;
    }
    std::vector<std::uint32_t> starts(stays_.size(), kNone);
    for (std::uint32_t v = 0; v < starts.size(); ++v)
      if (is_start[v] && on_sheet[v]) starts[v] = v;
    return starts;
  }

  void eat_sheets() {
    for (std::uint32_t v = 0; v < edges_at_.size(); ++v) eat_from(v);
    time_ = times();
    for (std::uint32_t e = 0; e < edges_.size(); ++e) offer(e);
    StopCheck stop(context_);
    while (!front_.empty()) {
      stop.did(20);
      const std::uint32_t edge = std::get<2>(front_.top());
      front_.pop();
      if (cofaces_[edge] != 1 || !edge_left_[edge]) continue;
      const auto around = triangles_of_[edge];
      remove_triangle(*std::find_if(around.begin(), around.end(),
                                    [&](std::uint32_t t) { return triangles_left_[t] != 0; }));
      remove_edge(edge);
    }
  }

  void offer(std::uint32_t edge) {
    if (cofaces_[edge] != 1 || !edge_left_[edge]) return;
    for (const std::uint32_t t : triangles_of_[edge]) {
      if (!triangles_left_[t]) continue;
      double all = 0, here = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = sheet_.triangles[t][k];
        const double time = time_[3 * t + k];
        all += time;
        if (v == edges_[edge][0] || v == edges_[edge][1]) here += time;
      }
      front_.push({all, here, edge});
    }
  }

  void remove_triangle(std::uint32_t t) {
    triangles_left_[t] = 0;
    for (const std::uint32_t e : edges_of_[t]) {
      --cofaces_[e];
      offer(e);
    }
  }

  void remove_edge(std::uint32_t edge) {
    edge_left_[edge] = 0;
    for (const std::uint32_t v : edges_[edge]) {
      --edges_at_[v];
      eat_from(v);
    }
  }

  // A line from its end, as far as it has no branch.
  void eat_from(std::uint32_t v) {
    while (edges_at_[v] == 1 && !stays_[v]) {
      const auto around = edges_round_[v];
      const std::uint32_t edge =
          *std::find_if(around.begin(), around.end(), [&](std::uint32_t e) { return edge_left_[e] != 0; });
      if (cofaces_[edge] != 0) return;
      edge_left_[edge] = 0;
      edges_at_[v] = 0;
      gone_.push_back(v);
      v = all_.other_end(edge, v);
      --edges_at_[v];
    }
  }

  // What is left has no rim.  Of each piece of triangles one goes that closed surfaces pass through, where E is
  // least: a membrane that only hangs between them would leave a tunnel.
  bool open_closed_ones() {
    DisjointSets together(sheet_.triangles.size()), patches = together;
    for_each_left([&](std::span<const std::uint32_t> round) {
      for (const std::uint32_t t : round) together.unite(round.front(), t);
      if (round.size() == 2) patches.unite(round[0], round[1]);
    });
    // A set of patches is closed when every edge meets an even number of them; a patch is in no such set when
    // these conditions add up to that it is not.
    ParityRows conditions;
    for_each_left([&](std::span<const std::uint32_t> round) {
      if (round.size() == 2) return;
      ParityRow row;
      for (const std::uint32_t t : round) row = parity_sum(row, {patches.find(t)});
      conditions.add(std::move(row));
    });
    std::map<std::uint32_t, bool> closed;  // by patch
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> least;
    for (std::uint32_t t = 0; t < triangles_left_.size(); ++t) {
      if (!triangles_left_[t]) continue;
      const std::uint32_t patch = patches.find(t);
      const auto [known_patch, fresh_patch] = closed.try_emplace(patch, false);
      if (fresh_patch) known_patch->second = !conditions.contains({patch});
      if (!known_patch->second) continue;
      double sum = 0;
      for (const std::uint32_t v : sheet_.triangles[t]) sum += sheet_.vertices[v].erosion;
      const std::pair here{sum, t};
      const auto [known, fresh] = least.try_emplace(together.find(t), here);
      if (here < known->second) known->second = here;
    }
    for (const auto& [piece, found] : least) {
      const Triangle& corners = sheet_.triangles[found.second];
      opened_.push_back(
          *std::min_element(corners.begin(), corners.end(), [&](std::uint32_t a, std::uint32_t b) {
            return sheet_.vertices[a].erosion < sheet_.vertices[b].erosion;
          }));
      remove_triangle(found.second);
    }
    return !least.empty();
  }

  // Calls visit(triangles) with those about each edge that are left, if there are any.
  template <class Visit>
  void for_each_left(const Visit& visit) const {
    std::vector<std::uint32_t> round;
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      round.clear();
      for (const std::uint32_t t : triangles_of_[e])
        if (triangles_left_[t]) round.push_back(t);
      if (!round.empty()) visit(std::span<const std::uint32_t>(round));
    }
  }

  void drop_centres_on_loops() {
    std::map<std::uint32_t, std::int64_t> euler;  // per piece: of what is left
    for (const std::uint32_t centre : centres_) euler[pieces_.find(centre)] = 0;
    const auto count = [&](std::uint32_t v, std::int64_t by) {
      if (const auto known = euler.find(pieces_.find(v)); known != euler.end()) known->second += by;
    };
    const std::vector<char> there = vertices_left();
    for (std::uint32_t v = 0; v < there.size(); ++v)
      if (there[v]) count(v, 1);
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      if (edge_left_[e]) count(edges_[e][0], -1);
    for (const std::uint32_t centre : centres_) {
      if (euler[pieces_.find(centre)] == 1) continue;
      stays_[centre] = 0;
      eat_from(centre);
    }
  }

  std::vector<char> vertices_left() const {
    std::vector<char> there(sheet_.vertices.size(), 1);
    for (const std::uint32_t v : gone_) there[v] = 0;
    return there;
  }

  SheetLines lines() const {
    SheetLines all{std::vector<std::uint32_t>(sheet_.vertices.size()), {}, opened_};
    std::iota(all.vertices.begin(), all.vertices.end(), 0U);
    std::vector<Segment> segments;
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      if (edge_left_[e]) segments.push_back(edges_[e]);
    return numbered_anew(all, vertices_left(), std::move(segments));
  }

  // When the triangle goes, which of its edges goes with it first, and that edge.
  using Offer = std::tuple<double, double, std::uint32_t>;

  const SheetMesh& sheet_;
  ExecutionContext* context_;
  DisjointSets pieces_;  // of vertices
  std::vector<char> stays_;
  const SheetEdges all_;
  const std::vector<Segment>& edges_ = all_.edges;
  const std::vector<std::array<std::uint32_t, 3>>& edges_of_ = all_.of;
  const Groups<std::uint32_t>&triangles_of_ = all_.triangles, &edges_round_ = all_.round;
  std::vector<char> edge_left_, triangles_left_;
  std::vector<std::uint32_t> cofaces_, edges_at_;  // that are left, per edge and per vertex
  std::vector<double> time_;                       // per corner of a triangle
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> front_;
  std::vector<std::uint32_t> gone_, centres_, opened_;
};

}  // namespace

SheetLines sheet_lines(const SheetMesh& sheet, std::span<const char> ends, ExecutionContext* context) {
  return Collapse(sheet, ends, context).run();
}

SheetLines numbered_anew(const SheetLines& lines, std::span<const char> stays,
                         std::vector<Segment> segments) {
  SheetLines result{{}, std::move(segments), lines.opened};
  std::vector<std::uint32_t> number(stays.size(), 0);
  for (std::uint32_t v = 0; v < stays.size(); ++v) {
    if (!stays[v]) continue;
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(lines.vertices[v]);
  }
  for (auto& [a, b] : result.segments) {
    a = number[a];
    b = number[b];
  }
  return result;
}

SheetLines left_of(const SheetLines& lines, std::vector<Segment> segments) {
  std::vector<char> had(lines.vertices.size(), 0), has(had);
  for (const Segment& s : lines.segments)
    for (const std::uint32_t v : s) had[v] = 1;
  for (const Segment& s : segments)
    for (const std::uint32_t v : s) has[v] = 1;
  for (std::uint32_t v = 0; v < had.size(); ++v) has[v] = has[v] || !had[v];
  return numbered_anew(lines, has, std::move(segments));
}

}  // namespace affskel::core
