#include "core/mesh/mesh_topology.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>

#include "base/number_text.h"
#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/none.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

std::uint32_t previous_corner(std::uint32_t h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

std::uint32_t from(const Mesh& mesh, std::uint32_t h) {
  return mesh.triangles[h / 3][h % 3];
}
std::uint32_t to(const Mesh& mesh, std::uint32_t h) {
  return from(mesh, h % 3 == 2 ? h - 2 : h + 1);
}

using Sides = std::span<const EdgeSide>;

// The corner opposite to the half-edge.  Over a common edge triangles are the same when these are.
std::uint32_t tip(const Mesh& mesh, std::uint32_t h) {
  return from(mesh, previous_corner(h));
}

// The first side whose triangle comes again, and where it does; null when none does.  Of a book of a hundred
// thousand leaves not every two are compared.
std::pair<const EdgeSide*, const EdgeSide*> first_repeated(const Mesh& mesh, Sides sides) {
  std::vector<std::pair<std::uint32_t, const EdgeSide*>> leaves;
  for (const EdgeSide& side : sides) leaves.emplace_back(tip(mesh, side.half_edge), &side);
  std::sort(leaves.begin(), leaves.end());
  std::pair<const EdgeSide*, const EdgeSide*> found{nullptr, nullptr};
  for (std::size_t i = 1; i < leaves.size(); ++i) {
    if (leaves[i - 1].first == leaves[i].first && (!found.first || leaves[i - 1].second < found.first))
      found = {leaves[i - 1].second, leaves[i].second};
  }
  return found;
}

// Counts open and crowded edges, names the first of each, and repeated triangles.
class EdgeDefects {
 public:
  EdgeDefects(const Mesh& mesh, const TrianglePlace& place, const EdgePlace& edge)
      : mesh_(mesh), place_(place), edge_(edge) {}

  void see(Sides sides) {
    if (sides.size() == 2 && tip(mesh_, sides[0].half_edge) != tip(mesh_, sides[1].half_edge)) return;
    note(sides.size() == 1 ? open_ : crowded_, sides);
    if (!repeated_.empty()) return;
    const auto [once, again] = first_repeated(mesh_, sides);
    if (once != nullptr)
      repeated_ = place_(once->triangle()) + " and " + place_(again->triangle()) + " are the same";
  }

  void throw_if_any() const {
    if (open_.count == 0 && crowded_.count == 0) return;
    std::string message = "the mesh does not bound a solid: ";
    if (!repeated_.empty()) message += repeated_ + "; ";
    if (open_.count != 0) message += tell(open_, "open edge", " (one triangle only)");
    if (open_.count != 0 && crowded_.count != 0) message += "; ";
    if (crowded_.count != 0) message += tell(crowded_, "edge", " where more than two triangles meet");
    if (open_.count != 0)
      message +=
          "; fill its holes first, by affskel-client repair, MeshLab's Close Holes or Blender's Fill Holes";
    refuse(message);
  }

 private:
  struct Kind {
    std::uint64_t count = 0;
    std::string first;
  };

  void note(Kind& kind, Sides sides) {
    if (kind.count++ != 0) return;
    kind.first = edge_(sides[0].half_edge) + ", " + place_(sides[0].triangle());
    if (sides.size() > 2) kind.first += " and " + place_(sides.back().triangle());
  }

  static std::string tell(const Kind& kind, const char* what, const char* more) {
    return base::counted(kind.count, what) + more +
           (kind.count == 1 ? ", between " : ", the first between ") + kind.first;
  }

  const Mesh& mesh_;
  const TrianglePlace& place_;
  const EdgePlace& edge_;
  Kind open_, crowded_;
  std::string repeated_;
};

bool agree(const Mesh& mesh, std::uint32_t h, std::uint32_t mate) {
  return from(mesh, h) == to(mesh, mate) && to(mesh, h) == from(mesh, mate);
}

bool all_agree(const Mesh& mesh, const HalfEdges& mates) {
  for (std::uint32_t h = 0; h < mates.size(); ++h) {
    if (mates[h] > h && !agree(mesh, h, mates[h])) return false;
  }
  return true;
}

// Reverses triangle t; its half-edges 0,1,2 (ab, bc, ca) become (ac, cb, ba): edge i moves to 2 - i.
void turn_over(Mesh& mesh, HalfEdges& mates, std::uint32_t t) {
  std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  std::swap(mates[3 * t], mates[3 * t + 2]);
  for (std::uint32_t i = 0; i < 3; ++i) mates[mates[3 * t + i]] = 3 * t + i;
}

}  // namespace

HalfEdges find_mates(const Mesh& mesh, const TrianglePlace& place, const EdgePlace& edge) {
  HalfEdges mates(3 * mesh.triangles.size(), kNone);
  EdgeDefects defects(mesh, place, edge);
  Edges(mesh.points.size(), mesh.triangles).for_each([&](std::uint32_t, std::uint32_t, Sides sides) {
    defects.see(sides);
    if (sides.size() != 2) return;
    mates[sides[0].half_edge] = sides[1].half_edge;
    mates[sides[1].half_edge] = sides[0].half_edge;
  });
  defects.throw_if_any();
  return mates;
}

bool find_mates_if_closed(const Mesh& mesh, unsigned threads, HalfEdges& mates) {
  mates.assign(3 * mesh.triangles.size(), kNone);
  std::atomic<bool> closed{true};
  const auto visit = [&](std::uint32_t, std::uint32_t, Sides sides) {
    const std::uint32_t a = sides[0].half_edge, b = sides.size() == 2 ? sides[1].half_edge : a;
    if (b == a || tip(mesh, a) == tip(mesh, b)) {
      closed = false;
    } else {
      mates[a] = b;
      mates[b] = a;
    }
  };
  Edges(mesh.points.size(), mesh.triangles, threads).for_each(visit, threads);
  return closed;
}

bool every_edge_is_shared(const Mesh& mesh) {
  bool shared = true;
  Edges(mesh.points.size(), mesh.triangles).for_each([&](std::uint32_t, std::uint32_t, Sides sides) {
    shared = shared && sides.size() != 1;
  });
  return shared;
}

std::vector<std::uint32_t> orient_consistently(Mesh& mesh, HalfEdges& mates, const TrianglePlace& place) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  if (all_agree(mesh, mates)) return {};
  // Per triangle: 0 = not reached, 1 = as it is, 2 = to be turned over (relative to the first reached).
  std::vector<std::uint8_t> side(count, 0);
  std::vector<std::uint32_t> surface, turned;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    if (side[seed] != 0) continue;
    side[seed] = 1;
    surface.assign(1, seed);
    std::size_t wrong = 0;
    for (std::size_t at = 0; at < surface.size(); ++at) {
      const std::uint32_t t = surface[at];
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t other = mates[h] / 3;
        const auto wanted = static_cast<std::uint8_t>(agree(mesh, h, mates[h]) ? side[t] : 3 - side[t]);
        if (side[other] == 0) {
          side[other] = wanted;
          wrong += wanted == 2;
          surface.push_back(other);
        } else if (side[other] != wanted) {
          refuse("the mesh does not bound a solid: the surface through " + place(other) +
                 " has only one side (not orientable)");
        }
      }
    }
    const std::uint8_t minority = 2 * wrong <= surface.size() ? 2 : 1;
    for (std::uint32_t t : surface) {
      if (side[t] == minority) turned.push_back(t);
    }
  }
  std::sort(turned.begin(), turned.end());
  for (std::uint32_t t : turned) turn_over(mesh, mates, t);
  return turned;
}

std::uint32_t split_pinched_vertices(Mesh& mesh, const HalfEdges& mates) {
  std::vector<std::uint8_t> corner_seen(mates.size(), 0), vertex_seen(mesh.points.size(), 0);
  std::uint32_t added = 0;
  for (std::uint32_t start = 0; start < mates.size(); ++start) {
    if (corner_seen[start] != 0) continue;
    std::uint32_t vertex = from(mesh, start);
    if (vertex_seen[vertex] != 0) {
      const Vec3 twin = mesh.points[vertex];
      mesh.points.push_back(twin);
      vertex = static_cast<std::uint32_t>(mesh.points.size() - 1);
      ++added;
    } else {
      vertex_seen[vertex] = 1;
    }
    // Walk the fan: the half-edge arriving at this corner, seen from its other side, leaves it again.
    std::uint32_t h = start;
    do {
      corner_seen[h] = 1;
      mesh.triangles[h / 3][h % 3] = vertex;
      h = mates[previous_corner(h)];
    } while (h != start);
  }
  return added;
}

std::vector<std::uint32_t> connected_surfaces(const HalfEdges& mates, std::uint32_t& count) {
  DisjointSets surfaces(mates.size() / 3);
  for (std::uint32_t h = 0; h < mates.size(); ++h) surfaces.unite(h / 3, mates[h] / 3);
  return surfaces.numbers(count);
}

}  // namespace affskel::core
