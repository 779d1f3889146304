#include "derive/sheet_barriers.h"

#include <algorithm>

#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_coordinates.h"

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

std::vector<std::uint32_t> drop_below(double least, const std::vector<double>& barrier,
                                      std::vector<core::Triangle>& triangles,
                                      std::vector<core::Segment>& segments) {
  const auto is_low = [&](const auto& element) {
    return std::any_of(element.begin(), element.end(), [&](std::uint32_t v) { return barrier[v] < least; });
  };
  std::erase_if(triangles, is_low);
  std::erase_if(segments, is_low);
  std::vector<bool> used(barrier.size(), false);
  for (const core::Triangle& t : triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  for (const core::Segment& s : segments) {
    for (const std::uint32_t v : s) used[v] = true;
  }
  std::vector<std::uint32_t> dropped, number(barrier.size(), 0);
  for (std::uint32_t v = 0; v < barrier.size(); ++v) {
    number[v] = v - static_cast<std::uint32_t>(dropped.size());
    if (!used[v]) dropped.push_back(v);
  }
  for (core::Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = number[v];
  }
  for (core::Segment& s : segments) {
    for (std::uint32_t& v : s) v = number[v];
  }
  return dropped;
}

}  // namespace affskel::worker
