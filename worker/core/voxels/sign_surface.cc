// Notation: the corners of a cube are numbered by their bits, x first.  Places are in units of the spacing, from the
// lattice's first node, so that a cube's are in [i, i + 1].
#include "core/voxels/sign_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace affskel::core {
namespace {

constexpr double kMargin = 1e-3;  // of vertices from the ends of edges and the faces of cubes
constexpr int kHalvings = 40;
constexpr std::uint64_t kOperations = 10;  // to find the sign of a node

using Corners = std::array<unsigned, 4>;

// Counter-clockwise seen from outside of the cube.
constexpr Corners face_corners(unsigned axis, unsigned side) {
  const unsigned first = side << axis, u = 1U << (axis + 1) % 3, v = 1U << (axis + 2) % 3;
  return side == 1 ? Corners{first, first | u, first | u | v, first | v}
                   : Corners{first, first | v, first | u | v, first | u};
}

Vec3 corner_place(const Vec3& cube, unsigned corner) {
  return cube + Vec3{corner & 1 ? 1.0 : 0.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 1.0 : 0.0};
}

class Marcher {
 public:
  Marcher(const std::function<double(const Vec3&)>& f, const CubeLattice& lattice, ExecutionContext* context)
      : f_(f), lattice_(lattice), stop_(context) {}

  Mesh run() {
    const auto& [nx, ny, nz] = lattice_.nodes;
    for (std::size_t k = 0; k < nz; ++k) {
      below_.swap(above_);
      above_.resize(nx * ny);
      for (std::size_t j = 0; j < ny; ++j)
        for (std::size_t i = 0; i < nx; ++i) above_[j * nx + i] = value(place_of(i, j, k)) < 0 ? 1 : 0;
      if (k > 0) march_layer(k - 1);
      vertices_[(k + 1) % 2].clear();
    }
    turn_edges();
    for (Vec3& p : mesh_.points) p = in_lattice(p);
    return std::move(mesh_);
  }

 private:
  static Vec3 place_of(std::size_t i, std::size_t j, std::size_t k) {
    return {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
  }
  Vec3 in_lattice(const Vec3& p) const { return lattice_.low + lattice_.spacing * p; }
  double value(const Vec3& p) {
    stop_.did(kOperations);
    return f_(in_lattice(p));
  }

  void march_layer(std::size_t k) {
    const std::size_t nx = lattice_.nodes[0];
    for (std::size_t j = 0; j + 1 < lattice_.nodes[1]; ++j) {
      for (std::size_t i = 0; i + 1 < nx; ++i) {
        const std::size_t at = j * nx + i;
        inside_ = 0;
        for (unsigned c = 0; c < 8; ++c)
          inside_ |= static_cast<unsigned>((c & 4 ? above_ : below_)[at + (c & 1) + (c & 2 ? nx : 0)]) << c;
        if (inside_ != 0 && inside_ != 255) march_cube(place_of(i, j, k));
      }
    }
  }

  bool is_inside(unsigned corner) const { return (inside_ >> corner & 1) != 0; }

  void march_cube(const Vec3& cube) {
    cube_ = cube;
    for (unsigned c = 0; c < 8; ++c) values_[c] = value(corner_place(cube, c));
    struct Next {
      std::uint32_t vertex;
      bool alone;  // in its face
    };
    std::map<std::uint32_t, Next> next;  // along the lines on the cube's faces, the solid to the left
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned side = 0; side < 2; ++side) {
        const Corners q = face_corners(axis, side);
        const bool two = is_ambiguous(q), joined = two && are_joined(q);
        for (std::size_t i = 0; i < 4; ++i) {  // where the line comes in from an outer to an inner corner
          if (is_inside(q[i]) || !is_inside(q[(i + 1) % 4])) continue;
          std::size_t end = i + 1;
          while (is_inside(q[(end + 1) % 4])) ++end;
          if (joined) end += 2;  // round the outer corner before
          next[vertex_between(q[i], q[(i + 1) % 4])] = {vertex_between(q[end % 4], q[(end + 1) % 4]), !two};
        }
      }
    }
    std::vector<std::uint32_t> line;
    std::uint32_t v = next.begin()->first;
    do line.push_back(v), v = next[v].vertex;
    while (v != line.front());
    if (line.size() < next.size()) return fill_pyramids();
    const std::uint32_t apex = add_apex(line);
    for (const std::uint32_t from : line) {
      if (next[from].alone) turnable_.push_back(static_cast<std::uint32_t>(mesh_.triangles.size()));
      mesh_.triangles.push_back({from, next[from].vertex, apex});
    }
  }

  // Whether inner and outer corners take turns round a face.
  bool is_ambiguous(const Corners& q) const {
    return is_inside(q[0]) == is_inside(q[2]) && is_inside(q[1]) == is_inside(q[3]) &&
           is_inside(q[0]) != is_inside(q[1]);
  }
  // Then, whether the inner ones belong together.
  bool are_joined(const Corners& q) const {
    return (values_[q[0]] + values_[q[2]]) + (values_[q[1]] + values_[q[3]]) < 0;
  }

  std::uint32_t add_vertex(const Vec3& p) {
    mesh_.points.push_back(p);
    return static_cast<std::uint32_t>(mesh_.points.size() - 1);
  }

  std::uint32_t vertex_between(unsigned a, unsigned b) {
    if (!is_inside(a)) std::swap(a, b);
    const Vec3 inner = corner_place(cube_, a), outer = corner_place(cube_, b), twice = inner + outer;
    const auto coordinate = [](double doubled) { return static_cast<std::uint64_t>(doubled); };
    const std::uint64_t key = coordinate(twice.y) << 32 | coordinate(twice.x);
    // By the lower node's layer and whether the edge goes up from there.
    auto& layer = vertices_[coordinate(twice.z) / 2 % 2];
    const auto [place, is_new] = layer.try_emplace(key << 1 | (coordinate(twice.z) & 1), 0U);
    if (is_new) place->second = add_vertex(crossing(inner, outer));
    return place->second;
  }

  // Of the zero set with the way from an inner to an outer place.
  Vec3 crossing(const Vec3& inner, const Vec3& outer) {
    double low = 0, high = 1;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (value(inner + middle * (outer - inner)) < 0 ? low : high) = middle;
    }
    return inner + std::clamp(low, kMargin, 1 - kMargin) * (outer - inner);
  }

  std::uint32_t add_apex(std::span<const std::uint32_t> line) {
    constexpr double kStep = 1e-4;
    // Two will do but where the function is flat, as where values meet the isovalue.
    constexpr int kNewtonSteps = 10;
    Vec3 p;
    for (const std::uint32_t v : line) p = p + (1.0 / static_cast<double>(line.size())) * mesh_.points[v];
    double step = 1;
    for (int i = 0;; ++i) {
      for (std::size_t a = 0; a < 3; ++a) p[a] = std::clamp(p[a], cube_[a] + kMargin, cube_[a] + 1 - kMargin);
      if (i == kNewtonSteps || step < kMargin) break;
      const double at = value(p);
      const Vec3 slope =
          (1 / kStep) * Vec3{value(p + Vec3{kStep, 0, 0}) - at, value(p + Vec3{0, kStep, 0}) - at,
                             value(p + Vec3{0, 0, kStep}) - at};
      const double square = dot(slope, slope);
      step = std::abs(at) / std::sqrt(square);
      if (!(step <= 1)) break;  // so flat that the zero set seems beyond the cube
      p = p - (at / square) * slope;
    }
    return add_vertex(p);
  }

  // Each face is a square or, where a diagonal of it has ends of one sign and another none, two triangles.
  void fill_pyramids() {
    double sum = 0;
    for (const double at : values_) sum += at;
    const bool middle_inside = sum < 0;
    const Vec3 middle = cube_ + Vec3{0.5, 0.5, 0.5};
    std::array<std::uint32_t, 8> to_middle{};
    for (unsigned c = 0; c < 8; ++c) {
      if (is_inside(c) == middle_inside) continue;
      const Vec3 corner = corner_place(cube_, c);
      to_middle[c] = add_vertex(middle_inside ? crossing(middle, corner) : crossing(corner, middle));
    }
    const auto cut = [&](std::span<const unsigned> base) {
      std::vector<std::uint32_t> polygon;
      for (std::size_t i = 0; i < base.size(); ++i) {
        const unsigned c = base[i], after = base[(i + 1) % base.size()];
        if (is_inside(c) != middle_inside) polygon.push_back(to_middle[c]);
        if (is_inside(c) != is_inside(after)) polygon.push_back(vertex_between(c, after));
      }
      if (!middle_inside) std::reverse(polygon.begin(), polygon.end());
      for (std::size_t i = 2; i < polygon.size(); ++i)
        mesh_.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    };
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned side = 0; side < 2; ++side) {
        Corners q = face_corners(axis, side);
        int inner = 0;
        for (const unsigned c : q) inner += is_inside(c) ? 1 : 0;
        const bool two = is_ambiguous(q);
        if (inner % 2 == 0 && !two) {
          cut(q);
          continue;
        }
        // The diagonal from q[0] has ends of one sign, and of that which is joined.
        if (two ? is_inside(q[0]) != are_joined(q) : is_inside(q[0]) != is_inside(q[2]))
          std::rotate(q.begin(), q.begin() + 1, q.end());
        cut(std::array{q[0], q[1], q[2]});
        cut(std::array{q[2], q[3], q[0]});
      }
    }
  }

  // Over the lines of faces with an apex on both sides, where the way between the apexes lies nearer to the zero set, or
  // in a plane makes triangles more even.
  void turn_edges() {
    std::vector<std::pair<Segment, std::uint32_t>> lines;
    lines.reserve(turnable_.size());
    for (const std::uint32_t t : turnable_)
      lines.emplace_back(ascending(mesh_.triangles[t][0], mesh_.triangles[t][1]), t);
    std::sort(lines.begin(), lines.end());
    for (std::size_t i = 1; i < lines.size(); ++i) {
      if (lines[i - 1].first != lines[i].first) continue;
      Triangle &s = mesh_.triangles[lines[i - 1].second], &t = mesh_.triangles[lines[i].second];
      if (!is_better_turned(s, t)) continue;
      const Triangle old = s;
      s = {old[0], t[2], old[2]};
      t = {t[2], old[1], old[2]};
    }
  }
  bool is_better_turned(const Triangle& s, const Triangle& t) {
    constexpr double kFlat = 0.996;  // 5 degrees
    const Vec3 a = twice_area(mesh_, s), b = twice_area(mesh_, t);
    if (dot(a, b) > kFlat * norm(a) * norm(b)) return angle_at_apex(s) + angle_at_apex(t) > std::numbers::pi;
    return std::abs(value_between(s[2], t[2])) < std::abs(value_between(s[0], s[1]));
  }
  double value_between(std::uint32_t v, std::uint32_t w) {
    return value(0.5 * (mesh_.points[v] + mesh_.points[w]));
  }
  double angle_at_apex(const Triangle& t) const {
    const Vec3 a = mesh_.points[t[0]] - mesh_.points[t[2]], b = mesh_.points[t[1]] - mesh_.points[t[2]];
    return std::atan2(norm(cross(a, b)), dot(a, b));
  }

  const std::function<double(const Vec3&)>& f_;
  CubeLattice lattice_;
  StopCheck stop_;
  std::vector<std::uint8_t> below_, above_;  // whether the nodes of a layer are inside
  std::array<std::unordered_map<std::uint64_t, std::uint32_t>, 2> vertices_;  // on the edges of both layers
  Vec3 cube_;
  unsigned inside_ = 0;  // bits of the cube's corners
  std::array<double, 8> values_{};
  std::vector<std::uint32_t> turnable_;  // triangles over a line that is alone in its face
  Mesh mesh_;
};

}  // namespace

Mesh sign_surface(const std::function<double(const Vec3&)>& f, const CubeLattice& lattice,
                  ExecutionContext* context) {
  return Marcher(f, lattice, context).run();
}

}  // namespace affskel::core
