// A *fan*: the triangles about a vertex that hang together by edges of it at which no third one is.  Fire is in a fan once it
// comes to the vertex in it, or once it is the last that does not burn at one of the edges there.
#include "core/curve/burn_times.h"

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
  Fire(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left, ExecutionContext* context)
      : sheet_(sheet),
        edges_(edges),
        left_(left),
        stop_(context),
        fans_(3 * sheet.triangles.size()),
        burns_(3 * sheet.triangles.size(), 0),
        times_(3 * sheet.triangles.size(), std::numeric_limits<double>::infinity()) {}

  std::vector<double> run() {
    join_fans();
    for (std::uint32_t v = 0; v < sheet_.vertices.size(); ++v) spread(v, 0);
    while (!front_.empty()) {
      stop_.did(20);
      const auto [time, v, fan] = front_.top();
      front_.pop();
      if (burns_[fan]) continue;
      light(fan, v, time);
      spread(v, time);
    }
    for (std::uint32_t corner = 0; corner < times_.size(); ++corner)
      times_[corner] = times_[fans_.find(corner)];
    return std::move(times_);
  }

 private:
  std::uint32_t fan(std::uint32_t t, std::uint32_t v) {
    const Triangle& corners = sheet_.triangles[t];
    return fans_.find(3 * t + (corners[0] == v ? 0 : corners[1] == v ? 1 : 2));
  }

  void join_fans() {
    std::vector<std::uint32_t> there;
    for (std::uint32_t e = 0; e < edges_.edges.size(); ++e) {
      there.clear();
      for (const std::uint32_t t : edges_.triangles[e])
        if (left_[t]) there.push_back(t);
      if (there.size() != 2) continue;
      for (const std::uint32_t v : edges_.edges[e]) fans_.unite(fan(there[0], v), fan(there[1], v));
    }
  }

  // Into what is the last at an edge of a vertex.
  void spread(std::uint32_t v, double time) {
    for (bool any = true; any;) {
      any = false;
      for (const std::uint32_t e : edges_.round[v]) {
        std::uint32_t count = 0, last = 0;
        for (const std::uint32_t t : edges_.triangles[e]) {
          if (!left_[t] || burns_[fan(t, v)]) continue;
          ++count;
          last = fan(t, v);
        }
        if (count != 1) continue;
        light(last, v, time);
        any = true;
      }
    }
  }

  void light(std::uint32_t burning, std::uint32_t v, double time) {
    burns_[burning] = 1;
    times_[burning] = time;
    for (const std::uint32_t from : edges_.about[v]) {
      if (!left_[from] || fan(from, v) != burning) continue;
      for_each_step(sheet_, edges_, left_, from, v, [&](std::uint32_t to, std::uint32_t t) {
        const std::uint32_t next = fan(t, to);
        const double there = time + norm(sheet_.vertices[v].position - sheet_.vertices[to].position);
        if (burns_[next] || !(there < times_[next])) return;
        times_[next] = there;
        front_.push({there, to, next});
      });
    }
  }

  using Arrival = std::tuple<double, std::uint32_t, std::uint32_t>;  // when, at which vertex, in which fan

  const SheetMesh& sheet_;
  const SheetEdges& edges_;
  std::span<const char> left_;
  StopCheck stop_;
  DisjointSets fans_;          // of corners of triangles
  std::vector<char> burns_;    // per fan, by its first corner
  std::vector<double> times_;  // likewise: the earliest known
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> front_;
};

}  // namespace

std::vector<double> burn_times(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left,
                               ExecutionContext* context) {
  return Fire(sheet, edges, left, context).run();
}

}  // namespace affskel::core
