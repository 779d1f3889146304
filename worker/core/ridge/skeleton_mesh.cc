#include "core/ridge/skeleton_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/groups.h"
#include "core/base/matrix3.h"
#include "core/base/unit.h"
#include "core/contour/dual_contour.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

constexpr int kRimPasses = 4;    // each evens a rim out over one more neighbour
constexpr int kFreePasses = 30;  // of ways and membranes: over about five neighbours

class Placing {
 public:
  Placing(const Solid& solid, const DualComplex& complex, const CellSet& left, const SkeletonParts& from)
      : complex_(complex),
        from_(from),
        membership_(solid.mesh),
        to_mesh_(inverse_transposed(frame_matrix(from.lattice))) {
    left.for_each([&](Cell cell) {
      const int dimension = DualComplex::dimension(cell);
      if (dimension == 0) vertices_.push_back(cell);
      if (dimension == 1) edges_.push_back(cell);
      if (dimension == 2) squares_.push_back(cell);
    });
  }

  SheetMesh run(ExecutionContext* context) {
    number_cells();
    make_vertices();
    throw_if_stopped(context);
    draw_rims();
    even_out(rim_neighbours_, fixed_on_rim(), kRimPasses, context);
    even_out(neighbours_, bound_, kFreePasses, context);
    make_faces();
    return std::move(mesh_);
  }

 private:
  std::uint32_t number(Cell vertex) const {
    return static_cast<std::uint32_t>(std::lower_bound(vertices_.begin(), vertices_.end(), vertex) -
                                      vertices_.begin());
  }

  std::array<std::uint32_t, 2> ends(Cell edge) const {
    std::array<std::uint32_t, 2> result{};
    std::size_t n = 0;
    complex_.for_each_face(edge, [&](Cell vertex) { result[n++] = number(vertex); });
    return result;
  }

  void number_cells() {
    for (const Cell edge : edges_) segments_.push_back(ends(edge));
    rings_.reserve(squares_.size());
    squares_at_edge_.assign(edges_.size(), 0);
    for (const Cell square : squares_) {
      auto& ring = rings_.emplace_back();
      const auto around = vertices_round(complex_, square);
      for (std::size_t k = 0; k < 4; ++k) ring[k] = number(around[k]);
      complex_.for_each_face(square, [&](Cell edge) {
        ++squares_at_edge_[static_cast<std::size_t>(std::lower_bound(edges_.begin(), edges_.end(), edge) -
                                                    edges_.begin())];
      });
    }
    neighbours_ = neighbours_along([](std::uint8_t) { return true; });
    rim_neighbours_ = neighbours_along([](std::uint8_t squares) { return squares == 1; });
  }

  template <class Wanted>
  Groups<std::uint32_t> neighbours_along(const Wanted& wanted) const {
    return {vertices_.size(), [&](const auto& put) {
              for (std::size_t e = 0; e < segments_.size(); ++e) {
                if (!wanted(squares_at_edge_[e])) continue;
                put(segments_[e][0], segments_[e][1]);
                put(segments_[e][1], segments_[e][0]);
              }
            }};
  }

  void make_vertices() {
    const std::vector<CellPlace> places = cells_of_vertices(from_.lattice, vertices_);
    bound_.assign(vertices_.size(), 0);
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      mesh_.vertices.push_back(free_vertex(vertices_[v], places[v]));
      mesh_.part.push_back(from_.parts.of_point(DualComplex::cube_of(vertices_[v])));
    }
    std::vector<char> in_surface(vertices_.size(), 0), on_curve(vertices_.size(), 0);
    CellSet squares(complex_), edges(complex_);
    for (const Anchor& anchor : from_.anchors.anchors)
      (DualComplex::dimension(anchor.cell) == 2 ? squares : edges).insert(anchor.cell);
    for (std::size_t s = 0; s < squares_.size(); ++s) {
      const bool ridge = squares.has(squares_[s]);
      for (const std::uint32_t v : rings_[s]) {
        in_surface[v] |= static_cast<char>(ridge);
        mesh_.vertices[v].kind = SkeletonKind::kMembrane;
      }
    }
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (!in_surface[v]) continue;
      const auto at = std::lower_bound(from_.cells.vertex.begin(), from_.cells.vertex.end(), vertices_[v]);
      mesh_.vertices[v].kind = SkeletonKind::kRidge;
      if (at == from_.cells.vertex.end() || *at != vertices_[v]) continue;  // the centre of a round part
      mesh_.vertices[v] = from_.surface[static_cast<std::size_t>(at - from_.cells.vertex.begin())];
      bound_[v] = 1;
    }
    for (const CurvePlace& place : from_.anchors.curves) {
      const std::uint32_t v = number(place.vertex);
      if (v == vertices_.size() || vertices_[v] != place.vertex || bound_[v]) continue;
      mesh_.vertices[v] = place.at;
      mesh_.vertices[v].kind = SkeletonKind::kCurve;
      bound_[v] = 1;
    }
    for (const Anchor& anchor : from_.anchors.anchors) {
      if (DualComplex::dimension(anchor.cell) == 0) bound_[number(anchor.cell)] = 1;
    }
  }

  // Of a sample point at a corner of a cell.
  Vec3 place_of(const DualComplex::Star::Member& corner, const CellPlace& cell) const {
    const auto along = [&](std::size_t axis) {
      return static_cast<double>(cell[axis]) + (DualComplex::digit(corner.place, axis) == 0 ? 1 : 0);
    };
    return from_.lattice.spacing * Vec3{along(0), along(1), along(2)};
  }

  // In the middle of the sample points about it.
  SheetVertex free_vertex(Cell vertex, const CellPlace& cell) const {
    const auto star = complex_.star(vertex);
    const double share = 1 / static_cast<double>(star.count);
    SheetVertex result;
    Vec3 gradient;
    result.point = star.members[0].cube;
    for (const DualComplex::Star::Member& member : star) {
      const std::uint32_t cube = member.cube;
      result.position = result.position + share * place_of(member, cell);
      result.erosion += share * from_.field.erosion[cube];
      result.area += share * section_area(to_mesh_, from_.field.gradient[cube]);
      gradient = gradient + unit(from_.field.gradient[cube]);
    }
    if (!inside(result.position)) result.position = place_of(star.members[0], cell);
    result.normal_a = result.normal_b = unit(gradient);
    result.kind = SkeletonKind::kWay;
    return result;
  }

  bool inside(const Vec3& u) const {
    return membership_.contains(scaled_place(from_.lattice, (1 / from_.lattice.spacing) * u));
  }

  bool weak(std::uint32_t v) const { return mesh_.vertices[v].strength < from_.low; }

  void draw_rims() {
    std::vector<SheetVertex> drawn = mesh_.vertices;
    std::vector<std::uint32_t> met(vertices_.size(), 0);
    const auto draw = [&](std::uint32_t v, std::uint32_t to) {
      const SheetVertex &at = mesh_.vertices[v], &strong = mesh_.vertices[to];
      if (at.kind != SkeletonKind::kRidge || strong.kind != SkeletonKind::kRidge) return;
      if (rim_neighbours_[v].empty() || !weak(v) || weak(to)) return;
      // Strengths reach far up where the gradient vanishes; the line is near the weak end all the same.
      const double high = std::min(strong.strength, 4 * from_.low);
      const double t = high > at.strength ? (from_.low - at.strength) / (high - at.strength) : 0;
      drawn[v] = between(met[v] == 0 ? at : drawn[v], between(at, strong, std::clamp(t, 0.0, 1.0)),
                         1 / static_cast<double>(met[v] + 1));
      ++met[v];
    };
    for (const auto& ring : rings_) {
      for (std::size_t k = 0; k < 4; ++k) {
        draw(ring[k], ring[(k + 1) % 4]);
        draw(ring[k], ring[(k + 3) % 4]);
      }
    }
    // Corners, with no strong neighbour but across a square.
    const std::vector<std::uint32_t> beside = met;
    for (const auto& ring : rings_) {
      for (std::size_t k = 0; k < 4; ++k)
        if (beside[ring[k]] == 0) draw(ring[k], ring[(k + 2) % 4]);
    }
    for (std::uint32_t v = 0; v < met.size(); ++v)
      if (met[v] > 0) drawn[v].strength = from_.low;
    mesh_.vertices = std::move(drawn);
  }

  // Corners of the rim, and where something else begins, stay.
  std::vector<char> fixed_on_rim() const {
    std::vector<char> fixed(vertices_.size(), 1);
    for (std::uint32_t v = 0; v < fixed.size(); ++v)
      if (rim_neighbours_[v].size() == 2 && bound_[v]) fixed[v] = 0;
    return fixed;
  }

  // In each pass every vertex that is not fixed goes half way to the mean of its neighbours; at the end as far
  // back as the solid demands.
  void even_out(const Groups<std::uint32_t>& neighbours, const std::vector<char>& fixed, int passes,
                ExecutionContext* context) {
    std::vector<std::uint32_t> moving;
    for (std::uint32_t v = 0; v < vertices_.size(); ++v)
      if (!fixed[v] && !neighbours[v].empty()) moving.push_back(v);
    std::vector<Vec3> before(moving.size()), moved(moving.size());
    for (std::size_t n = 0; n < moving.size(); ++n) before[n] = mesh_.vertices[moving[n]].position;
    for (int pass = 0; pass < passes; ++pass) {
      throw_if_stopped(context);
      for (std::size_t n = 0; n < moving.size(); ++n) {
        const auto around = neighbours[moving[n]];
        Vec3 mean;
        for (const std::uint32_t to : around)
          mean = mean + (1 / static_cast<double>(around.size())) * mesh_.vertices[to].position;
        moved[n] = 0.5 * (mesh_.vertices[moving[n]].position + mean);
      }
      for (std::size_t n = 0; n < moving.size(); ++n) mesh_.vertices[moving[n]].position = moved[n];
    }
    StopCheck stop(context);
    for (std::size_t n = 0; n < moving.size(); ++n, stop.did(1000)) {
      Vec3& at = mesh_.vertices[moving[n]].position;
      double share = 1;
      while (share > 0.2 && !inside(before[n] + share * (moved[n] - before[n]))) share *= 0.5;
      at = share > 0.2 ? before[n] + share * (moved[n] - before[n]) : before[n];
    }
  }

  void make_faces() {
    for (const auto& ring : rings_) add_quad(ring, mesh_);
    for (std::size_t e = 0; e < segments_.size(); ++e)
      if (squares_at_edge_[e] == 0) mesh_.segments.push_back({segments_[e][0], segments_[e][1]});
  }

  const DualComplex& complex_;
  const SkeletonParts& from_;
  SolidMembership membership_;
  Matrix3 to_mesh_;  // F^-T
  std::vector<Cell> vertices_, edges_, squares_;
  std::vector<std::array<std::uint32_t, 2>> segments_;  // per edge: its ends
  std::vector<std::array<std::uint32_t, 4>> rings_;     // per square
  std::vector<std::uint8_t> squares_at_edge_;
  Groups<std::uint32_t> neighbours_, rim_neighbours_;
  std::vector<char> bound_;  // per vertex: its place is known
  SheetMesh mesh_;
};

}  // namespace

SheetMesh skeleton_mesh(const Solid& solid, const DualComplex& complex, const CellSet& left,
                        const SkeletonParts& from, ExecutionContext* context) {
  return Placing(solid, complex, left, from).run(context);
}

}  // namespace affskel::core
