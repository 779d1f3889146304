// Placing a vertex: least squares on the tangent planes of its cell's crossings, drawn towards their mean. On
// the rim the mean alone would lie on the outermost crossings, and a strip one crossing wide would have no
// area: there a vertex goes half way to the middle of its cell, in the sheet's plane.  What comes to lie
// outside the solid goes back to the crossings' mean or the nearest crossing.
#include "core/contour/dual_contour.h"

#include <algorithm>

#include "core/base/matrix3.h"
#include "core/base/unit.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/patch_senses.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

// Pull of the crossings' mean on a vertex, against 1 for all tangent planes together: enough to place a
// vertex along a sheet whose planes agree, little beside the planes themselves.
constexpr double kRegularisation = 0.05;

// @param m symmetric and positive definite.
Vec3 solve(const Matrix3& m, const Vec3& b) {
  const Vec3 c0 = cross(m[1], m[2]), c1 = cross(m[2], m[0]), c2 = cross(m[0], m[1]);
  return (1 / dot(m[0], c0)) * (b.x * c0 + (b.y * c1 + b.z * c2));
}

// Which places of the frame lie inside the parts of a solid.
class PartInterior {
 public:
  PartInterior(const SolidParts& parts, const Lattice& lattice) : lattice_(lattice), meshes_(parts.meshes()) {
    membership_.reserve(meshes_.size());
    for (const Mesh& mesh : meshes_) membership_.emplace_back(mesh);
  }

  bool contains(std::uint32_t part, const Vec3& u) const {
    return membership_[part].contains(scaled_from_frame(lattice_, u));
  }

 private:
  const Lattice& lattice_;
  std::vector<Mesh> meshes_;
  std::vector<SolidMembership> membership_;
};

class Contouring {
 public:
  Contouring(const Lattice& lattice, const SolidParts& parts, std::span<const SheetCrossing> crossings,
             const EdgeCells& cells)
      : spacing_(lattice.spacing), crossings_(crossings), cells_(cells), interior_(parts, lattice) {}

  std::vector<Vec3> vertices(ExecutionContext* context) const {
    std::vector<Vec3> result;
    result.reserve(cells_.size());
    StopCheck stop(context);
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      result.push_back(kept_inside(cell, place(cell)));
      stop.did(100);
    }
    return result;
  }

 private:
  Vec3 place(std::uint32_t cell) const {
    const std::span<const std::uint32_t> members = cells_.edges[cell];
    const Vec3& reference = crossings_[members[0]].normal;
    const double share = 1 / static_cast<double>(members.size());
    Vec3 mean, normal;
    Matrix3 m = kRegularisation * kIdentity3;
    for (std::uint32_t s : members) {
      mean = mean + share * crossings_[s].position;
      const Vec3 n = dot(crossings_[s].normal, reference) < 0 ? -crossings_[s].normal : crossings_[s].normal;
      normal = normal + n;
      m = m + outer(n, share * n);
    }
    const Vec3 corner = spacing_ * vector_of(cells_.place[cell]);
    const double h = spacing_;
    if (cells_.whole[cell]) {
      const Vec3 n = unit(normal), away = corner + Vec3{h / 2, h / 2, h / 2} - mean;
      mean = mean + 0.5 * (away - dot(away, n) * n);
    }
    Vec3 right;
    for (std::uint32_t s : members) {
      const Vec3& n = crossings_[s].normal;
      right = right + (share * dot(n, crossings_[s].position - mean)) * n;
    }
    const Vec3 p = mean + solve(m, right);
    return {std::clamp(p.x, corner.x, corner.x + h), std::clamp(p.y, corner.y, corner.y + h),
            std::clamp(p.z, corner.z, corner.z + h)};
  }

  Vec3 kept_inside(std::uint32_t cell, const Vec3& wanted) const {
    if (interior_.contains(cells_.part[cell], wanted)) return wanted;
    const std::span<const std::uint32_t> members = cells_.edges[cell];
    Vec3 mean, nearest = crossings_[members[0]].position;
    for (std::uint32_t s : members) {
      const Vec3& crossing = crossings_[s].position;
      mean = mean + (1 / static_cast<double>(members.size())) * crossing;
      if (norm(crossing - wanted) < norm(nearest - wanted)) nearest = crossing;
    }
    return interior_.contains(cells_.part[cell], mean) ? mean : nearest;
  }

  double spacing_;
  std::span<const SheetCrossing> crossings_;
  const EdgeCells& cells_;
  PartInterior interior_;
};

}  // namespace

void add_quad(const std::array<std::uint32_t, 4>& ring, SheetMesh& sheet) {
  const auto [a, b, c, d] = ring;
  const auto place = [&](std::uint32_t v) { return sheet.vertices[v].position; };
  const Vec3 ac = place(a) - place(c), bd = place(b) - place(d);
  if (dot(ac, ac) <= dot(bd, bd)) {
    sheet.triangles.push_back({a, b, c});
    sheet.triangles.push_back({a, c, d});
  } else {
    sheet.triangles.push_back({a, b, d});
    sheet.triangles.push_back({b, c, d});
  }
}

SheetMesh dual_contour(const Lattice& lattice, const SolidParts& parts, const EdgeCells& cells,
                       std::span<const SheetCrossing> crossings, const VertexOfCell& vertex_of,
                       ExecutionContext* context) {
  const std::vector<Vec3> places = Contouring(lattice, parts, crossings, cells).vertices(context);
  SheetMesh sheet;
  sheet.vertices.reserve(places.size());
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    sheet.vertices.push_back(vertex_of(places[cell], cells.edges[cell]));
    sheet.vertices.back().position = places[cell];
  }
  sheet.triangles.reserve(2 * crossings.size());
  for (const auto& ring : cells.ring) add_quad(ring, sheet);
  agree_on_senses(sheet.vertices.size(), sheet.triangles);
  sheet.part = cells.part;
  return sheet;
}

}  // namespace affskel::core
