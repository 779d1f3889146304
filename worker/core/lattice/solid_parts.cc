#include "core/lattice/solid_parts.h"

#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {

SolidParts::SolidParts(const Solid& solid, const Lattice& lattice) : solid_(solid), lattice_(lattice) {
  part_of_solid_ = joined_solids(solid).numbers(count_);
  points_.assign(count_, 0);
  for (const LatticeRun& run : lattice.axis[2].runs) points_[of_triangle(run.low)] += run.length;
}

std::uint32_t SolidParts::of_point(std::uint32_t point) const {
  if (count_ == 1) return 0;
  return of_triangle(run_of(lattice_, point).low);
}

std::vector<Mesh> SolidParts::meshes() const {
  // Of a vertex: the part it was last copied to, and its place there.
  std::vector<std::uint32_t> owner(solid_.mesh.points.size(), count_), place(solid_.mesh.points.size());
  std::vector<Mesh> result(count_);
  for (std::uint32_t t = 0; t < solid_.mesh.triangles.size(); ++t) {
    const std::uint32_t part = of_triangle(t);
    Mesh& mesh = result[part];
    Triangle corners = solid_.mesh.triangles[t];
    for (std::uint32_t& corner : corners) {
      if (owner[corner] != part) {
        owner[corner] = part;
        place[corner] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(solid_.mesh.points[corner]);
      }
      corner = place[corner];
    }
    mesh.triangles.push_back(corners);
  }
  return result;
}

}  // namespace affskel::core
