#include "derive_task.h"

#include <array>

#include "core/skeleton.h"
#include "core/surface.h"
#include "core/zucker_hummel.h"

namespace affskel::worker {
namespace {

// Walks the sample points once, in order, while the skeleton's points come by in the same order.
class Walker {
 public:
  explicit Walker(const PreparedJob& job) : job_(job), places_(job.solid(), job.lattice()) {}

  core::Vec3 place(std::uint32_t point) {
    const std::vector<core::LatticeRun>& runs = job_.lattice().axis[2].runs;
    while (point >= runs[at_].first + runs[at_].length) ++at_;
    const core::LatticeRun& run = runs[at_];
    return places_.at(run.start[0], run.start[1], run.start[2] + (point - run.first));
  }

 private:
  const PreparedJob& job_;
  core::SamplePlaces places_;
  std::size_t at_ = 0;
};

void add(const core::Vec3& v, google::protobuf::RepeatedField<double>* list) {
  list->Add(v.x);
  list->Add(v.y);
  list->Add(v.z);
}

}  // namespace

v1::SkeletonPoints derive_skeleton(const PreparedJob& job, std::string_view stored,
                                   const v1::SkeletonParams& params) {
  const std::vector<core::FieldValue> field = unpack_field(stored, job.lattice().points);
  core::OptimalDirections optimal;
  optimal.reserve(field.size());
  for (const core::FieldValue& value : field) optimal.push_back(value.direction);
  const std::vector<double> divergence =
      core::zucker_hummel_divergence(job.lattice(), job.directions(), optimal);
  core::SkeletonOptions options;
  if (params.threshold() != 0) options.threshold = params.threshold();
  Walker walker(job);
  v1::SkeletonPoints message;
  for (const core::SkeletonPoint& kept : core::skeleton_points(divergence, options)) {
    const core::FieldValue& value = field[kept.point];
    message.add_point(kept.point);
    add(walker.place(kept.point), message.mutable_xyz());
    message.add_erosion(value.erosion);
    add(value.direction == core::FieldValue::kNoDirection ? core::Vec3{} : job.directions()[value.direction],
        message.mutable_normal());
    message.add_direction(value.direction);
    message.add_divergence(kept.divergence);
  }
  return message;
}

v1::TriangleMesh derive_surface(const PreparedJob& job, std::string_view stored,
                                const v1::SurfaceParams& params) {
  const v1::SkeletonPoints skeleton = derive_skeleton(job, stored, params.skeleton());
  std::vector<core::Vec3> points;
  for (int i = 0; i < skeleton.point_size(); ++i) {
    points.push_back({skeleton.xyz(3 * i), skeleton.xyz(3 * i + 1), skeleton.xyz(3 * i + 2)});
  }
  core::AlphaSurfaceOptions options;
  options.alpha = params.alpha();
  options.spacing = job.lattice().spacing;
  const core::Mesh surface = core::alpha_surface(points, options);
  v1::TriangleMesh message;
  for (const core::Vec3& p : surface.points) add(p, message.mutable_xyz());
  for (const core::Triangle& t : surface.triangles) {
    for (std::uint32_t v : t) message.add_corners(v);
  }
  return message;
}

}  // namespace affskel::worker
