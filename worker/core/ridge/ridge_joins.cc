// Nodes of the graph: the sample points by rank, then the vertices of the mesh.  A piece is named by its
// least vertex.
#include "core/ridge/ridge_joins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/cheapest_ways.h"
#include "core/base/disjoint_sets.h"
#include "core/base/groups.h"
#include "core/base/matrix3.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/lattice_edges.h"
#include "core/ridge/ridge_values.h"

namespace affskel::core {
namespace {

constexpr int kSmoothingPasses = 8;

struct Pieces {
  DisjointSets sets;
  std::vector<char> searching;  // per vertex that names a piece: not the largest of its part
  bool apart = false;           // a part has several
};

Pieces pieces_of(const SheetMesh& mesh) {
  Pieces pieces{DisjointSets(mesh.vertices.size()), std::vector<char>(mesh.vertices.size(), 0)};
  for (const Triangle& t : mesh.triangles) {
    pieces.sets.unite(t[0], t[1]);
    pieces.sets.unite(t[0], t[2]);
  }
  for (const Segment& s : mesh.segments) pieces.sets.unite(s[0], s[1]);
  std::vector<std::uint32_t> size(mesh.vertices.size(), 0);
  for (std::uint32_t v = 0; v < size.size(); ++v) ++size[pieces.sets.find(v)];
  std::map<std::uint32_t, std::uint32_t> largest;  // per part
  for (std::uint32_t v = 0; v < size.size(); ++v) {
    if (size[v] == 0) continue;
    const auto [known, fresh] = largest.try_emplace(mesh.part[v], v);
    if (fresh) continue;
    pieces.apart = true;
    pieces.searching[v] = 1;
    if (size[v] > size[known->second]) std::swap(pieces.searching[v], pieces.searching[known->second]);
    if (!pieces.searching[v]) known->second = v;
  }
  return pieces;
}

class Joining {
 public:
  Joining(SheetMesh& mesh, Pieces pieces, const Lattice& lattice, const FrameField& field)
      : mesh_(mesh),
        pieces_(std::move(pieces)),
        lattice_(lattice),
        field_(field),
        points_(lattice.points),
        cheapest_(sources()),
        beside_(lattice.points, [&](const auto& put) {
          for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) put(mesh.vertices[v].point, v);
        }) {
    for (auto& side : neighbours_) side.assign(points_, kNoNode);
    for_each_edge(lattice, [&](std::uint32_t low, std::uint32_t high, std::uint8_t axis, const auto&) {
      neighbours_[axis][low] = high;
      neighbours_[3U + axis][high] = low;
    });
  }

  std::uint32_t run(const std::function<bool(const Vec3&)>& inside, double max_length) {
    search();
    std::uint32_t count = 0;
    const auto ends = [&](const Way& way) {
      return std::pair{cheapest_.source[way.a], cheapest_.source[way.b]};
    };
    take_cheapest(std::move(ways_), pieces_.sets, ends, [&](const Way& way) {
      const std::vector<std::uint32_t> nodes = nodes_along(way);
      std::vector<SheetVertex> line = line_of(nodes);
      smooth(line, inside);
      const double radius = std::sqrt(std::max(line.front().area, line.back().area) / std::numbers::pi);
      if (length_of(line) > max_length * radius) return false;
      put_in(line, nodes.front() - points_, nodes.back() - points_);
      ++count;
      return true;
    });
    return count;
  }

 private:
  struct Way {
    double cost;
    std::uint32_t a, b;  // neighbouring nodes of different pieces
    friend auto operator<=>(const Way&, const Way&) = default;
  };

  bool is_vertex(std::uint32_t node) const { return node >= points_; }

  // sqrt(E), of the sample point.
  double root(std::uint32_t node) const {
    return std::sqrt(field_.erosion[is_vertex(node) ? mesh_.vertices[node - points_].point : node]);
  }

  // Between neighbours; infinite where E is 0.
  double cost(std::uint32_t a, std::uint32_t b) const { return 2 * field_.spacing / (root(a) + root(b)); }

  template <class Visit>
  void neighbours_of(std::uint32_t node, Visit visit) const {
    if (is_vertex(node)) {
      visit(mesh_.vertices[node - points_].point);
      return;
    }
    for (const auto& side : neighbours_)
      if (side[node] != kNoNode) visit(side[node]);
    for (const std::uint32_t v : beside_[node]) visit(points_ + v);
  }

  // Per node its piece, where it is a vertex.
  std::vector<std::uint32_t> sources() {
    std::vector<std::uint32_t> result(points_ + mesh_.vertices.size(), kNoNode);
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) result[points_ + v] = pieces_.sets.find(v);
    return result;
  }

  // From all pieces that search; the others wait.
  void search() {
    const auto steps = [&](std::uint32_t node, const auto& go) {
      neighbours_of(node, [&](std::uint32_t to) {
        const double step = cost(node, to);
        if (go(to, step, node)) return;
        const std::uint32_t piece = cheapest_.source[to];
        if (piece != kNoNode && piece != cheapest_.source[node])
          ways_.push_back(
              {cheapest_.cost[node] + step + cheapest_.cost[to], std::min(node, to), std::max(node, to)});
      });
    };
    cheapest_.find(steps, [&](std::uint32_t node) { return pieces_.searching[cheapest_.source[node]] != 0; });
  }

  // From the vertex at one end to that at the other.
  std::vector<std::uint32_t> nodes_along(const Way& way) const {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t n = way.a; n != kNoNode; n = cheapest_.step[n]) nodes.push_back(n);
    std::reverse(nodes.begin(), nodes.end());
    for (std::uint32_t n = way.b; n != kNoNode; n = cheapest_.step[n]) nodes.push_back(n);
    return nodes;
  }

  std::vector<SheetVertex> line_of(const std::vector<std::uint32_t>& nodes) const {
    std::vector<std::uint32_t> ranks(nodes.begin() + 1, nodes.end() - 1);
    std::sort(ranks.begin(), ranks.end());
    const std::vector<LatticePlace> places = lattice_places(lattice_, ranks);
    const Matrix3 to_mesh = inverse_transposed(frame_matrix(lattice_));
    std::vector<SheetVertex> line{mesh_.vertices[nodes.front() - points_]};
    for (std::size_t n = 1; n + 1 < nodes.size(); ++n) {
      const auto at = std::lower_bound(ranks.begin(), ranks.end(), nodes[n]) - ranks.begin();
      const auto& [i, j, k] = places[static_cast<std::size_t>(at)];
      SheetVertex vertex;
      vertex.position = lattice_.spacing * Vec3{double(i), double(j), double(k)};
      vertex.point = nodes[n];
      vertex.erosion = field_.erosion[nodes[n]];
      vertex.area = section_area(to_mesh, field_.gradient[nodes[n]]);
      line.push_back(vertex);
    }
    line.push_back(mesh_.vertices[nodes.back() - points_]);
    return line;
  }

  static void smooth(std::vector<SheetVertex>& line, const std::function<bool(const Vec3&)>& inside) {
    for (int pass = 0; pass < kSmoothingPasses; ++pass) {
      for (std::size_t n = 1; n + 1 < line.size(); ++n) {
        const Vec3 middle = 0.5 * (line[n - 1].position + line[n + 1].position);
        const Vec3 moved = 0.5 * (line[n].position + middle);
        if (inside(moved)) line[n].position = moved;
      }
    }
  }

  static double length_of(const std::vector<SheetVertex>& line) {
    double length = 0;
    for (std::size_t n = 1; n < line.size(); ++n) length += norm(line[n].position - line[n - 1].position);
    return length;
  }

  void put_in(const std::vector<SheetVertex>& line, std::uint32_t first, std::uint32_t last) {
    std::uint32_t before = first;
    const std::uint32_t part = mesh_.part[first];
    for (std::size_t n = 1; n + 1 < line.size(); ++n) {
      const auto here = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(line[n]);
      mesh_.part.push_back(part);
      mesh_.segments.push_back({before, here});
      before = here;
    }
    mesh_.segments.push_back({before, last});
  }

  SheetMesh& mesh_;
  Pieces pieces_;
  const Lattice& lattice_;
  const FrameField& field_;
  std::uint32_t points_;
  CheapestWays cheapest_;
  Groups<std::uint32_t> beside_;                          // per sample point: the vertices at it
  std::array<std::vector<std::uint32_t>, 6> neighbours_;  // of the sample points
  std::vector<Way> ways_;
};

}  // namespace

std::uint32_t join_pieces(SheetMesh& mesh, const Lattice& lattice, const FrameField& field,
                          const std::function<bool(const Vec3&)>& inside, double max_length) {
  Pieces pieces = pieces_of(mesh);
  if (!pieces.apart || max_length == 0) return 0;
  return Joining(mesh, std::move(pieces), lattice, field).run(inside, max_length);
}

}  // namespace affskel::core
