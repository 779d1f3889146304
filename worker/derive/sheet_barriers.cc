#include "derive/sheet_barriers.h"

#include <algorithm>

#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/unused_points.h"

namespace affskel::worker {

core::SheetPlace sheet_place(const FinishedField& field, const core::Vec3& position,
                             const core::Vec3& normal_a, const core::Vec3& normal_b) {
  const core::Lattice& lattice = field.lattice();
  return {core::scaled_place(lattice, (1 / lattice.spacing) * position), field.normal_to_mesh(normal_a),
          field.normal_to_mesh(normal_b)};
}

std::vector<double> barriers_at(const FinishedField& field, const std::vector<core::SheetPlace>& places) {
  core::BarrierOptions options;
  options.frame = core::frame_matrix(field.lattice());
  options.threads = field.threads();
  options.context = field.context();
  return core::barriers(field.job().solid(), places, options);
}

std::vector<std::uint32_t> drop_below(double least, const std::vector<double>& barrier, core::Mesh& sheet) {
  std::erase_if(sheet.triangles, [&](const core::Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return barrier[v] < least; });
  });
  return core::drop_unused_points(sheet);
}

}  // namespace affskel::worker
