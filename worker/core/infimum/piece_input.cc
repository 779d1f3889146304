#include "core/infimum/piece_input.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "core/base/disjoint_sets.h"
#include "core/base/double_sum.h"
#include "core/mesh/box.h"
#include "core/mesh/edges.h"
#include "core/mesh/mesh_topology.h"

namespace affskel::core {
namespace {

constexpr double kUnit = 0x1p62;  // see SurfaceSums

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

// The vertices in preorder of trees that are found breadth first, so that their branches stay short; parents
// by old numbers.
struct Preorder {
  std::vector<std::uint32_t> order, parent;
};

Preorder preorder_of(const Mesh& mesh) {
  const Adjacency around = neighbours(mesh.points.size(), mesh.triangles);
  Preorder result{{}, std::vector<std::uint32_t>(mesh.points.size(), PieceInput::kNone)};
  std::vector<std::uint32_t> first_child(mesh.points.size(), PieceInput::kNone),
      next_sibling(mesh.points.size(), PieceInput::kNone);
  std::vector<std::uint32_t> queue, stack;
  for (std::uint32_t root = 0; root < mesh.points.size(); ++root) {
    if (result.parent[root] != PieceInput::kNone) continue;
    result.parent[root] = root;
    queue.assign(1, root);
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const std::uint32_t v = queue[at];
      for (const std::uint32_t child : around[v]) {
        if (result.parent[child] != PieceInput::kNone) continue;
        result.parent[child] = v;
        next_sibling[child] = first_child[v];
        first_child[v] = child;
        queue.push_back(child);
      }
    }
    stack.assign(1, root);
    while (!stack.empty()) {
      const std::uint32_t v = stack.back();
      stack.pop_back();
      result.order.push_back(v);
      for (std::uint32_t c = first_child[v]; c != PieceInput::kNone; c = next_sibling[c]) stack.push_back(c);
    }
  }
  return result;
}

}  // namespace

double SurfaceSums::volume_from(const Vec3& x) const {
  DoubleSum sum = restored(value[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const DoubleSum area = restored(value[k + 1]);
    sum.add(times(area, -x[static_cast<int>(k)]));
  }
  return sum.value();
}

PieceInput::PieceInput(const Solid& solid, unsigned threads) {
  number_anew(solid);
  find_mates_if_closed(mesh, threads, mates);
  sum_up();
  find_handles();
  find_rings();
  std::vector<std::uint8_t> bounded(solid.solid_volume.size(), 0);
  for (const Shell& shell : shells) {
    if (bounded[shell.solid] != 0 && !rays) rays.emplace(mesh, threads);
    bounded[shell.solid] = 1;
  }
  for (const double v : solid.solid_volume) volume += std::ldexp(v, -3 * solid.exponent);
}

void PieceInput::number_anew(const Solid& solid) {
  const std::vector<std::uint32_t> triangle_order = tree.build(boxes_of(solid.mesh));
  const Preorder vertices = preorder_of(solid.mesh);
  std::vector<std::uint32_t> number(vertices.order.size()), triangle_number(triangle_order.size());
  for (std::uint32_t v = 0; v < number.size(); ++v) number[vertices.order[v]] = v;
  mesh.points.reserve(number.size());
  parent.reserve(number.size());
  for (const std::uint32_t v : vertices.order) {
    mesh.points.push_back(solid.mesh.points[v]);
    parent.push_back(number[vertices.parent[v]]);
  }
  mesh.triangles.reserve(triangle_order.size());
  for (const std::uint32_t t : triangle_order) {
    triangle_number[t] = static_cast<std::uint32_t>(mesh.triangles.size());
    const Triangle& c = solid.mesh.triangles[t];
    mesh.triangles.push_back({number[c[0]], number[c[1]], number[c[2]]});
  }
  end.resize(number.size());
  shell_of.resize(number.size());
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    end[v] = v + 1;
    if (parent[v] == v) shells.push_back({v, 0, {}});
    shell_of[v] = static_cast<std::uint32_t>(shells.size() - 1);
  }
  for (std::uint32_t v = static_cast<std::uint32_t>(number.size()); v-- > 0;) {
    end[parent[v]] = std::max(end[parent[v]], end[v]);
  }
  for (std::uint32_t t = 0; t < triangle_order.size(); ++t) {
    shells[shell_of[mesh.triangles[t][0]]].solid =
        solid.shells[solid.triangle_shell[triangle_order[t]]].solid;
  }
  if (!solid.crossings.empty()) add_crossings(solid, triangle_number);
}

// Solids that pass through each other are one from here on.
void PieceInput::add_crossings(const Solid& solid, const std::vector<std::uint32_t>& triangle_number) {
  crosses.assign(mesh.points.size(), 0);
  DisjointSets solids(solid.solid_volume.size());
  for (const auto& [i, j] : solid.crossings) {
    crossings.emplace_back(triangle_number[i], triangle_number[j]);
    for (const std::uint32_t t : {triangle_number[i], triangle_number[j]}) {
      for (const std::uint32_t v : mesh.triangles[t]) crosses[v] = 1;
    }
    solids.unite(solid.shells[solid.triangle_shell[i]].solid, solid.shells[solid.triangle_shell[j]].solid);
  }
  for (Shell& shell : shells) shell.solid = solids.find(shell.solid);
}

void PieceInput::sum_up() {
  constexpr double kThird = 1.0 / 3;
  area_vector.reserve(mesh.triangles.size());
  own.reserve(mesh.triangles.size());
  before.resize(mesh.points.size() + 1);
  for (const Triangle& c : mesh.triangles) {
    const Vec3& p = mesh.points[c[0]];
    const Vec3 area = 0.5 * cross(mesh.points[c[1]] - p, mesh.points[c[2]] - p);
    area_vector.push_back(area);
    own.push_back({{quantised(kThird * dot(area, p)), quantised(kThird * area.x), quantised(kThird * area.y),
                    quantised(kThird * area.z)}});
    before[c[0] + 1] += own.back();
  }
  for (std::size_t v = 1; v < before.size(); ++v) before[v] += before[v - 1];
}

// A tree of triangles across edges that the vertices' tree does not use; what is left of the edges goes round
// the handles.
void PieceInput::find_handles() {
  DisjointSets joined(mesh.triangles.size());
  for (std::uint32_t h = 0; h < mates.size(); ++h) {
    if (mates[h] < h) continue;
    const std::uint32_t t = h / 3;
    const std::uint32_t a = mesh.triangles[t][h % 3], b = mesh.triangles[t][(h + 1) % 3];
    if (parent[a] == b || parent[b] == a) continue;
    if (joined.unite(t, mates[h] / 3)) continue;
    shells[shell_of[a]].handles.push_back({a, b});
    at_handle.resize(mates.size(), 0);
    at_handle[h] = at_handle[mates[h]] = 1;
  }
}

void PieceInput::find_rings() {
  owner.assign(mesh.points.size(), PieceInput::kNone);
  std::vector<std::uint32_t> start(mesh.points.size());  // half-edges that leave the vertex
  for (std::uint32_t h = 0; h < mates.size(); ++h) {
    start[mesh.triangles[h / 3][h % 3]] = h;
    owner[mesh.triangles[h / 3][h % 3]] = h / 3;
  }
  rings = {mesh.points.size(), [&](const auto& put) {
             for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
               std::uint32_t h = start[v];
               do {
                 put(v, mesh.triangles[h / 3][(h + 1) % 3]);
                 const std::uint32_t into = h / 3 * 3 + (h + 2) % 3;  // the half-edge of the triangle into v
                 h = mates[into];
               } while (h != start[v]);
             }
           }};
}

}  // namespace affskel::core
