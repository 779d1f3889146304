// A *fan*: the triangles about a vertex that hang together by edges at which no others meet.
#include "core/curve/burn_times.h"

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "core/base/disjoint_sets.h"

namespace affskel::core {
namespace {

class Fire {
 public:
  Fire(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left,
       std::span<const char> held)
      : sheet_(sheet),
        edges_(edges),
        left_(left),
        fans_(3 * sheet.triangles.size()),
        fan_is_burned_(3 * sheet.triangles.size(), 0),
        unburned_(held.begin(), held.end()),
        times_(sheet.vertices.size(), std::numeric_limits<double>::infinity()) {
    for (std::uint32_t& count : unburned_) count = count != 0;
  }

  std::vector<double> run() {
    light();
    burn();
    while (true) {
      for (const auto& [time, v] : waiting_) burn_vertex(v, time);
      waiting_.clear();
      if (front_.empty()) break;
      burn();
    }
    return std::move(times_);
  }

 private:
  bool is_burned(std::uint32_t v) const { return std::isfinite(times_[v]); }

  std::uint32_t corner(std::uint32_t t, std::uint32_t v) const {
    const Triangle& corners = sheet_.triangles[t];
    return 3 * t + (corners[0] == v ? 0 : corners[1] == v ? 1 : 2);
  }

  void light() {
    std::vector<std::uint32_t> there;
    for (std::uint32_t e = 0; e < edges_.edges.size(); ++e) {
      there.clear();
      for (const std::uint32_t t : edges_.triangles[e])
        if (left_[t]) there.push_back(t);
      for (const std::uint32_t v : edges_.edges[e]) {
        if (there.size() == 2) fans_.unite(corner(there[0], v), corner(there[1], v));
        if (there.size() == 1) front_.push({0, v, corner(there[0], v)});
      }
    }
    for (std::uint32_t t = 0; t < sheet_.triangles.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k)
        unburned_[sheet_.triangles[t][k]] += left_[t] && fans_.find(3 * t + k) == 3 * t + k;
  }

  void burn() {
    while (!front_.empty()) {
      const auto [time, v, at] = front_.top();
      front_.pop();
      if (std::exchange(fan_is_burned_[fans_.find(at)], 1)) continue;
      if (--unburned_[v] <= 1)
        burn_vertex(v, time);
      else
        waiting_.push_back({time, v});
    }
  }

  void burn_vertex(std::uint32_t v, double time) {
    if (is_burned(v)) return;
    times_[v] = time;
    for_each_step(sheet_, edges_, left_, v, [&](std::uint32_t to, std::uint32_t t) {
      const double way = norm(sheet_.vertices[v].position - sheet_.vertices[to].position);
      if (!is_burned(to)) front_.push({time + way, to, corner(t, to)});
    });
  }

  struct Wait {
    double time;
    std::uint32_t vertex;
  };
  using Arrival = std::tuple<double, std::uint32_t, std::uint32_t>;  // when, at which vertex, in which fan

  const SheetMesh& sheet_;
  const SheetEdges& edges_;
  std::span<const char> left_;
  DisjointSets fans_;                    // of corners of triangles
  std::vector<char> fan_is_burned_;      // by its first corner
  std::vector<std::uint32_t> unburned_;  // fans, per vertex, and what is held there
  std::vector<double> times_;
  std::vector<Wait> waiting_;
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> front_;
};

}  // namespace

std::vector<double> burn_times(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left,
                               std::span<const char> held) {
  return Fire(sheet, edges, left, held).run();
}

}  // namespace affskel::core
