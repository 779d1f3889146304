#include "core/infimum/piece_input.h"

#include <algorithm>
#include <cmath>

#include "core/base/basis.h"
#include "core/base/disjoint_sets.h"
#include "core/base/double_sum.h"
#include "core/base/unit.h"
#include "core/mesh/box.h"
#include "core/mesh/edges.h"
#include "core/mesh/mesh_topology.h"
#include "core/mesh/unused_points.h"

namespace affskel::core {
namespace {

constexpr double kUnit = 0x1p62;     // see SurfaceSums
constexpr double kLevelTurn = 1e-9;  // volume that edges of unit length span: less is level within rounding

std::uint64_t quantised(double value) {
  return static_cast<std::uint64_t>(std::llrint(value * kUnit));
}

DoubleSum restored(std::uint64_t value) {
  const auto whole = static_cast<std::int64_t>(value);
  const double hi = static_cast<double>(whole);
  // A double of 2^63 would not fit back; the sums of a piece stay below 2^62.
  const double lo = static_cast<double>(whole - static_cast<std::int64_t>(hi));
  return {hi / kUnit, lo / kUnit};
}

// Edges that join all vertices of each shell, of the least length together (Kruskal 1956): of all such, planes cut fewest of
// these on the mean, as many as they are long (Cauchy, Crofton).
std::vector<Segment> shortest_trees(const Mesh& mesh) {
  std::vector<std::pair<double, Segment>> by_length;
  by_length.reserve(mesh.triangles.size() / 2 * 3);
  Edges(mesh.points.size(), mesh.triangles).for_each([&](std::uint32_t a, std::uint32_t b, const auto&) {
    by_length.emplace_back(norm(mesh.points[b] - mesh.points[a]), Segment{a, b});
  });
  std::ranges::sort(by_length);
  DisjointSets joined(mesh.points.size());
  std::vector<Segment> trees;
  for (const auto& [length, edge] : by_length) {
    if (joined.unite(edge[0], edge[1])) trees.push_back(edge);
  }
  return trees;
}

// The vertices in preorder.
std::vector<std::uint32_t> preorder_of(const BreadthFirstTrees& trees) {
  const std::vector<std::uint32_t>& parent = trees.parent;
  std::vector<std::uint32_t> first_child(parent.size(), kNone), next_sibling(parent.size(), kNone), order,
      stack;
  for (const std::uint32_t v : trees.order) {
    if (parent[v] != v) next_sibling[v] = std::exchange(first_child[parent[v]], v);
  }
  for (std::uint32_t root = 0; root < parent.size(); ++root) {
    if (parent[root] != root) continue;
    stack.assign(1, root);
    while (!stack.empty()) {
      const std::uint32_t v = stack.back();
      stack.pop_back();
      order.push_back(v);
      for (std::uint32_t c = first_child[v]; c != kNone; c = next_sibling[c]) stack.push_back(c);
    }
  }
  return order;
}

}  // namespace

double SurfaceSums::volume_from(const Vec3& x) const {
  DoubleSum sum = restored(value[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const DoubleSum area = restored(value[k + 1]);
    sum.add(times(area, -x[k]));
  }
  return sum.value();
}

PieceInput::PieceInput(const Solid& solid, unsigned threads) {
  auto pairs = number_anew(solid);
  find_mates_if_closed(mesh, threads, mates_);
  sum_up();
  find_handles();
  find_passages();
  find_rings();
  crossings = CrossingPairs(mesh, rings, link_crossings(mesh, mates_, std::move(pairs)));
  find_saddles();
  is_ball = shells.size() == 1 && shells[0].handles.empty() && crossings.empty();
  mates_ = {};
  parent_ = {};
  std::vector<std::uint8_t> bounded(solid.solid_volume.size(), 0);
  for (const Shell& shell : shells) {
    if (bounded[shell.solid] != 0 && !rays) rays.emplace(mesh, threads);
    bounded[shell.solid] = 1;
  }
  for (const double v : solid.solid_volume) volume += solid.scaled(v);
}

// The pairs that pass through each other, too.
std::vector<std::pair<std::uint32_t, std::uint32_t>> PieceInput::number_anew(const Solid& solid) {
  const std::vector<std::uint32_t> triangle_order = FourTree().build(boxes_of(solid.mesh));
  std::vector<std::uint32_t> triangle_number(triangle_order.size());
  Mesh in_order{solid.mesh.points, {}};
  in_order.triangles.reserve(triangle_order.size());
  for (const std::uint32_t t : triangle_order) {
    triangle_number[t] = static_cast<std::uint32_t>(in_order.triangles.size());
    in_order.triangles.push_back(solid.mesh.triangles[t]);
  }
  mesh = numbered_by_first_use(in_order);
  plant_trees();
  for (std::uint32_t t = 0; t < triangle_order.size(); ++t) {
    shells[shell_of[mesh.triangles[t][0]]].solid = solid.solid_of(triangle_order[t]);
  }
  join_solids(solid);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const auto& [i, j] : solid.crossings) pairs.emplace_back(triangle_number[i], triangle_number[j]);
  return pairs;
}

void PieceInput::plant_trees() {
  BreadthFirstTrees trees = breadth_first_trees(neighbours(mesh.points.size(), shortest_trees(mesh)));
  const std::vector<std::uint32_t> order = preorder_of(trees);
  parent_ = std::move(trees.parent);
  branches.resize(mesh.points.size());
  shell_of.resize(mesh.points.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint32_t v = order[i];
    branches[v] = {i, 1};
    if (parent_[v] == v) shells.push_back({v, 0, {}});
    shell_of[v] = static_cast<std::uint32_t>(shells.size() - 1);
  }
  for (auto v = order.rbegin(); v != order.rend(); ++v) {
    if (parent_[*v] != *v) branches[parent_[*v]].count += branches[*v].count;
  }
}

// Solids that pass through each other are one from here on.
void PieceInput::join_solids(const Solid& solid) {
  DisjointSets solids = joined_solids(solid);
  for (Shell& shell : shells) shell.solid = solids.find(shell.solid);
}

void PieceInput::sum_up() {
  constexpr double kThird = 1.0 / 3;
  faces.reserve(mesh.triangles.size());
  std::vector<SurfaceSums> before(mesh.points.size() +
                                  1);  // over the triangles of vertices before, in preorder
  for (const Triangle& c : mesh.triangles) {
    const Vec3& p = mesh.points[c[0]];
    const Vec3 area = 0.5 * twice_area(mesh, c);
    faces.push_back({area,
                     {{quantised(kThird * dot(area, p)), quantised(kThird * area.x),
                       quantised(kThird * area.y), quantised(kThird * area.z)}}});
    before[branches[c[0]].first + 1] += faces.back().sums;
  }
  for (std::size_t v = 1; v < before.size(); ++v) before[v] += before[v - 1];
  below.resize(mesh.points.size());
  for (std::size_t v = 0; v < below.size(); ++v) {
    below[v] = before[branches[v].end()];
    below[v] -= before[branches[v].first];
  }
}

// A tree of triangles across edges that the vertices' tree does not use; what is left of the edges goes round
// the handles.
void PieceInput::find_handles() {
  DisjointSets joined(mesh.triangles.size());
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) edges.push_back({v, parent_[v], kNone, kNone});
  for (std::uint32_t h = 0; h < mates_.size(); ++h) {
    if (mates_[h] < h) continue;
    const std::uint32_t a = begin_of(h), b = end_of(h);
    if (parent_[a] == b || parent_[b] == a) continue;
    if (joined.unite(h / 3, mates_[h] / 3)) continue;
    shells[shell_of[a]].handles.push_back({a, b});
    edges.push_back({a, b, h, mates_[h]});
  }
}

void PieceInput::find_passages() {
  passages.resize(mates_.size());
  for (std::uint32_t h = 0; h < mates_.size(); ++h) {
    const std::uint32_t back = mates_[h], t = back / 3, i = back % 3;
    passages[h] = {mesh.triangles[t][(i + 2) % 3], 3 * t + (i + 1) % 3, 3 * t + (i + 2) % 3, kNone};
    Edge& to_parent = edges[begin_of(h)];
    if (to_parent.end != end_of(h)) continue;
    to_parent.there = h;
    to_parent.back = back;
  }
  std::vector<Box> boxes(edges.size());
  for (std::uint32_t n = 0; n < edges.size(); ++n) {
    const Edge& edge = edges[n];
    boxes[n] = {mesh.points[edge.begin], mesh.points[edge.end]};
    if (edge.there != kNone) passages[edge.there].edge = passages[edge.back].edge = n;
  }
  edge_tree.build(boxes);
}

void PieceInput::find_rings() {
  std::vector<std::uint32_t> start(mesh.points.size());  // half-edges that leave the vertex
  for (std::uint32_t h = 0; h < mates_.size(); ++h) start[begin_of(h)] = h;
  rings = {mesh.points.size(), [&](const auto& put) {
             for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
               std::uint32_t h = start[v];
               do {
                 put(v, end_of(h));
                 const std::uint32_t into = h / 3 * 3 + (h + 2) % 3;  // the half-edge of the triangle into v
                 h = mates_[into];
               } while (h != start[v]);
             }
           }};
}

// No plane through such a vertex has more than one stretch of its neighbours below.
bool PieceInput::is_convex(std::uint32_t vertex) const {
  if (!crossings.at(vertex).empty()) return false;
  const auto ring = rings[vertex];
  int left = 0, right = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::array<Vec3, 3> edge = {unit(mesh.points[ring[i]] - mesh.points[vertex]),
                                      unit(mesh.points[ring[(i + 1) % ring.size()]] - mesh.points[vertex]),
                                      unit(mesh.points[ring[(i + 2) % ring.size()]] - mesh.points[vertex])};
    const double turn = dot(edge[0], cross(edge[1], edge[2]));
    left += turn > kLevelTurn;
    right += turn < -kLevelTurn;
  }
  return std::max(left, right) == static_cast<int>(ring.size());
}

// With the surface's normal n as the pole, let ring vertices have azimuths that go once round, r their distance
// from the pole's axis and h their height.  A plane of inclination f puts those below whose
// r sin(f) cos(azimuth - the plane's) + h cos(f) < 0.  Without the heights that is one stretch of the ring; they
// change it only at vertices whose |cos| is at most c = cot(f) max |h / r|, near the stretch's two ends.  Where
// all gaps between azimuths are wider than 2 asin(c), an end has one such vertex at most: one stretch remains.
PieceInput::Saddle PieceInput::saddle_at(std::uint32_t vertex) const {
  constexpr double kSlack = 1.01, kShortest = 1e-6;
  const auto ring = rings[vertex];
  const std::size_t count = ring.size();
  Saddle saddle;
  saddle.vertex = vertex;
  const auto edge = [&](std::size_t i) { return mesh.points[ring[i % count]] - mesh.points[vertex]; };
  Vec3 sum;
  for (std::size_t i = 0; i < count; ++i) sum = sum + cross(edge(i), edge(i + 1));
  saddle.normal = unit(sum);
  Vec3 u, w;
  make_basis(saddle.normal, u, w);
  double steepest = 0, least_gap = 1;  // h / r; 1 - cos
  int turns = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 e = edge(i), next = edge(i + 1);
    const double a = dot(u, e), b = dot(w, e), next_a = dot(u, next), next_b = dot(w, next);
    const double r = std::sqrt(a * a + b * b), next_r = std::sqrt(next_a * next_a + next_b * next_b);
    if (!(r > kShortest && next_r > kShortest) || a * next_b - b * next_a <= 0) return saddle;
    steepest = std::max(steepest, std::abs(dot(saddle.normal, e)) / r);
    least_gap = std::min(least_gap, 1 - (a * next_a + b * next_b) / (r * next_r));
    turns += b < 0 && next_b >= 0;
  }
  if (turns != 1) return saddle;
  const double tangent_squared =
      kSlack * steepest * steepest / (0.5 * least_gap) + (kSlack - 1) * (kSlack - 1);
  saddle.cosine = 1 / std::sqrt(1 + tangent_squared);
  saddle.sine = std::sqrt(tangent_squared) * saddle.cosine;
  return saddle;
}

void PieceInput::find_saddles() {
  std::vector<Box> boxes;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (is_convex(v)) continue;
    saddles.push_back(saddle_at(v));
    boxes.emplace_back().include(mesh.points[v]);
  }
  saddle_tree.build(boxes);
}

}  // namespace affskel::core
