#include "reference_time.h"

#include <algorithm>
#include <cstdint>

#include "clocks.h"
#include "job.h"
#include "published_program.h"

namespace affskel::bench {
namespace {

constexpr std::uint32_t kMaxPublishedTriangles = 500;
constexpr std::size_t kFirstSample = 8;

// The solid's own mesh in mesh units, so that both programs see the same surface.
core::Mesh mesh_of(const core::Solid& solid) {
  core::Mesh mesh = solid.mesh;
  for (core::Vec3& p : mesh.points) p = solid.centre + solid.scale() * p;
  return mesh;
}

}  // namespace

std::optional<ReferenceTime> run_reference(const RowSpec& row, const std::string& off_file, double budget_s) {
  if (row.spacing <= 0 || row.mesh.triangles > kMaxPublishedTriangles) return std::nullopt;
  RowSpec all = row;
  all.max_directions = 0;
  const Job job(off_file, all, 1);
  const core::Mesh mesh = mesh_of(job.solid());
  reference::PublishedOptions options;
  options.spacing = options.step = job.lattice().spacing;
  // The service's order of directions: any stretch of it is spread evenly over the triangles.
  const std::vector<std::uint32_t>& order = job.list();
  double points_s = 0, erosion_s = 0;
  std::size_t timed = 0, next = kFirstSample;
  while (timed < order.size() && erosion_s < budget_s) {
    const std::size_t end = std::min(order.size(), timed + next);
    options.triangles.assign(order.begin() + static_cast<std::ptrdiff_t>(timed),
                             order.begin() + static_cast<std::ptrdiff_t>(end));
    const double start = thread_cpu_now();
    const reference::PublishedField field = reference::published_program(mesh, options);
    const double spent = thread_cpu_now() - start;
    const double share = field.erosion_s / (field.erosion_s + field.points_s);
    erosion_s += spent * share;
    points_s = spent * (1 - share);
    timed = end;
    next = timed;  // doubles the sample
  }
  const double scale = static_cast<double>(order.size()) / static_cast<double>(timed);
  return ReferenceTime{points_s + erosion_s * scale, timed};
}

}  // namespace affskel::bench
