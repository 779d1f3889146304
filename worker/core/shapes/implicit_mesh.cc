// Notation: lattice nodes carry doubled integer coordinates, so that the corners of the cubes are the
// all-even triples and the centres the all-odd ones.  A *face* is the square between two neighbouring
// cubes; with the two centres it spans an octahedron, cut into four tetrahedra round the axis that joins
// the centres.  These tetrahedra fill space.
#include "core/shapes/implicit_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/mesh/laplacian.h"

namespace affskel::core {
namespace {

using Node = std::array<std::int32_t, 3>;

/// 21 bits per coordinate; nodes start at 0.
std::uint64_t node_key(const Node& n) {
  return (static_cast<std::uint64_t>(n[0]) << 42) | (static_cast<std::uint64_t>(n[1]) << 21) |
         static_cast<std::uint64_t>(n[2]);
}

struct EdgeHash {
  std::size_t operator()(const std::pair<std::uint64_t, std::uint64_t>& e) const {
    return static_cast<std::size_t>((e.first * 0x9E3779B97F4A7C15u) ^ (e.second * 0xC2B2AE3D27D4EB4Fu));
  }
};

/// The square between cube `low` (its centre) and the next cube along `axis`, as a number; numbers are in the order of
/// the centres, x first.
using Face = std::uint64_t;
Face face_of(const Node& low, int axis) {
  Face face = 0;
  for (const std::int32_t centre : low) face = face << 20 | static_cast<Face>(centre / 2);
  return face << 2 | static_cast<Face>(axis);
}
std::pair<Node, std::size_t> low_and_axis(Face face) {
  const auto centre = [&](int shift) { return static_cast<std::int32_t>(face >> shift & 0xFFFFF) * 2 + 1; };
  return {{centre(42), centre(22), centre(2)}, static_cast<std::size_t>(face & 3)};
}

/// What belongs to nodes near one x.  Faces come in the order of x, and one touches nodes from half a cube before its
/// centre to a cube behind it, so that what lies before is let go.
template <class Map>
class Slabs {
 public:
  Map& at(std::int32_t x) { return slabs_[static_cast<std::size_t>(x) % 4]; }
  /// The next faces have their centres at x.
  void advance(std::int32_t x) {
    for (; before_ < x - 1; ++before_) at(before_).clear();
  }

 private:
  std::array<Map, 4> slabs_;
  std::int32_t before_ = 0;
};

class Marcher {
 public:
  Marcher(const ImplicitFunction& f, const ImplicitMeshOptions& options)
      : f_(f), low_(options.low), half_(options.spacing / 2) {
    const Vec3 size = options.high - options.low;
    for (std::size_t k = 0; k < 3; ++k) {
      cubes_[k] = std::max(1, static_cast<std::int32_t>(std::ceil(size[k] / options.spacing)));
    }
  }

  Mesh run() {
    std::int32_t side = 1;
    while (side < *std::max_element(cubes_.begin(), cubes_.end())) side *= 2;
    collect_faces({0, 0, 0}, side);
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
    for (const Face face : faces_) march_face(face);
    return std::move(mesh_);
  }

 private:
  Vec3 position(const Node& n) const { return low_ + Vec3{half_ * n[0], half_ * n[1], half_ * n[2]}; }

  double value(const Node& n) {
    const auto [place, is_new] = values_.at(n[0]).try_emplace(node_key(n), 0.0);
    if (is_new) place->second = f_(position(n));
    return place->second;
  }

  /// Descends into the block of side^3 cubes at cube `first` unless it lies clear of the zero set.
  void collect_faces(const Node& first, std::int32_t side) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (first[k] >= cubes_[k]) return;
    }
    const Node centre{2 * first[0] + side, 2 * first[1] + side, 2 * first[2] + side};
    const double radius = 1.001 * std::sqrt(3.0) * side * half_;
    if (std::abs(f_(position(centre))) > radius) return;
    if (side == 1) {
      add_faces(centre);
      return;
    }
    const std::int32_t h = side / 2;
    for (int octant = 0; octant < 8; ++octant) {
      collect_faces(
          {first[0] + (octant & 4 ? h : 0), first[1] + (octant & 2 ? h : 0), first[2] + (octant & 1 ? h : 0)},
          h);
    }
  }

  void add_faces(const Node& centre) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      if (centre[k] + 2 < 2 * cubes_[k]) faces_.push_back(face_of(centre, axis));
      if (centre[k] >= 2) {
        Node before = centre;
        before[k] -= 2;
        faces_.push_back(face_of(before, axis));
      }
    }
  }

  void march_face(Face face) {
    const auto [low, k] = low_and_axis(face);
    values_.advance(low[0]);
    vertices_.advance(low[0]);
    const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
    Node high = low;
    high[k] += 2;
    std::array<Node, 4> rim;  // counter-clockwise seen against the axis
    constexpr std::array<std::array<std::int32_t, 2>, 4> kCorner{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      rim[i] = low;
      rim[i][k] += 1;
      rim[i][u] += kCorner[i][0];
      rim[i][v] += kCorner[i][1];
    }
    for (std::size_t i = 0; i < 4; ++i) march_tetrahedron({low, rim[i], rim[(i + 1) % 4], high});
  }

  /// `t` is positively oriented: det(t1 - t0, t2 - t0, t3 - t0) > 0.
  void march_tetrahedron(const std::array<Node, 4>& t) {
    std::array<std::size_t, 4> order{};  // the inside corners, then the outside ones
    std::size_t inside = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (value(t[i]) < 0) order[inside++] = i;
    }
    if (inside == 0 || inside == 4) return;
    for (std::size_t i = 0, at = inside; i < 4; ++i) {
      if (!(value(t[i]) < 0)) order[at++] = i;
    }
    int inversions = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
    }
    if (inversions % 2 != 0) inside == 3 ? std::swap(order[0], order[1]) : std::swap(order[2], order[3]);
    const auto cut = [&](std::size_t i, std::size_t o) { return edge_vertex(t[order[i]], t[order[o]]); };
    if (inside == 1) {
      mesh_.triangles.push_back({cut(0, 1), cut(0, 2), cut(0, 3)});
    } else if (inside == 3) {
      mesh_.triangles.push_back({cut(0, 3), cut(1, 3), cut(2, 3)});
    } else {
      add_quadrangle({cut(0, 2), cut(0, 3), cut(1, 3), cut(1, 2)});
    }
  }

  /// Cut along the shorter diagonal; both lie inside the tetrahedron, so neighbours need not agree.
  void add_quadrangle(const std::array<std::uint32_t, 4>& q) {
    const auto length = [&](std::size_t i, std::size_t j) {
      return norm(mesh_.points[q[i]] - mesh_.points[q[j]]);
    };
    const bool first = length(0, 2) <= length(1, 3);
    mesh_.triangles.push_back(first ? Triangle{q[0], q[1], q[2]} : Triangle{q[0], q[1], q[3]});
    mesh_.triangles.push_back(first ? Triangle{q[0], q[2], q[3]} : Triangle{q[1], q[2], q[3]});
  }

  std::uint32_t edge_vertex(const Node& inner, const Node& outer) {
    const auto [place, is_new] = vertices_.at(std::min(inner[0], outer[0]))
                                     .try_emplace(std::pair(node_key(inner), node_key(outer)),
                                                  static_cast<std::uint32_t>(mesh_.points.size()));
    if (is_new) mesh_.points.push_back(cross_over(inner, outer));
    return place->second;
  }

  /// Kept away from the ends, so that the vertices round a node on the zero set stay distinct.
  Vec3 cross_over(const Node& inner, const Node& outer) {
    const double a = value(inner), b = value(outer);
    constexpr double kMargin = 0.05;
    const double t = std::clamp(a / (a - b), kMargin, 1 - kMargin);
    const Vec3 p = position(inner);
    return p + t * (position(outer) - p);
  }

  const ImplicitFunction& f_;
  Vec3 low_;
  double half_;  // half the cube's edge: the unit of the doubled coordinates
  std::array<std::int32_t, 3> cubes_{};
  Slabs<std::unordered_map<std::uint64_t, double>> values_;
  Slabs<std::unordered_map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t, EdgeHash>>
      vertices_;  // by less x
  std::vector<Face> faces_;
  Mesh mesh_;
};

/// Two Newton steps onto the zero set.
Vec3 project(const ImplicitFunction& f, double step, Vec3 p) {
  for (int i = 0; i < 2; ++i) {
    const double value = f(p);
    const Vec3 gradient{(f(p + Vec3{step, 0, 0}) - value) / step, (f(p + Vec3{0, step, 0}) - value) / step,
                        (f(p + Vec3{0, 0, step}) - value) / step};
    const double square = dot(gradient, gradient);
    if (square > 0) p = p - (value / square) * gradient;
  }
  return p;
}

}  // namespace

Mesh mesh_zero_set(const ImplicitFunction& f, const ImplicitMeshOptions& options) {
  return Marcher(f, options).run();
}

void fair_onto(const ImplicitFunction& f, double step, int rounds, Mesh& mesh) {
  for (int round = 0; round < rounds; ++round) {
    smooth(mesh, 1);
    for (Vec3& place : mesh.points) place = project(f, step, place);
  }
}

}  // namespace affskel::core
