#include "core/repair/cloud_surface.h"

#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/estimate_scale.h>
#include <CGAL/hierarchy_simplify_point_set.h>
#include <CGAL/jet_estimate_normals.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/property_map.h>
#include <CGAL/remove_outliers.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/plain_math.h"
#include "core/mesh/box.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/surface_mesh.h"
#include "core/solid/surface_samples.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

constexpr std::size_t kFewest = 100;
// Of more, CGAL would refine and solve for seconds without asking whether to stop.
constexpr std::size_t kMost = 50'000;
constexpr unsigned kApart = 6;  // neighbours whose mean distance is the spacing
// Neighbours that a normal is taken from: with 18 the two sides of an elephant's ears already run into one another.
constexpr unsigned kNeighbours = 12;
constexpr double kLone = 4;          // spacings from the neighbours, root mean square
constexpr std::size_t kAsked = 500;  // points whose surroundings are looked at for the noise
constexpr std::size_t kOfScale = 6;  // of neighbours that are a surface only together, one in so many stays
constexpr double kCube = 1.25;       // edge of the cubes in which the surface is sought, spacings
constexpr double kMostCubes = 1 << 24;
constexpr double kFar = 3;                  // spacings from each point
constexpr double kMostUnseen = 0.25;        // of the surface: five times what scans of bodies leave open
constexpr double kPlaneCloud = 1e-9;        // thickness of what is a plane, of the box's diagonal
constexpr std::uint64_t kOperations = 100;  // to find a value, some nanoseconds each

using Vector = Kernel::Vector_3;
using Oriented = std::pair<Point, Vector>;
using Places = CGAL::First_of_pair_property_map<Oriented>;
using Normals = CGAL::Second_of_pair_property_map<Oriented>;
using Sequential = CGAL::Sequential_tag;
using Poisson = CGAL::Poisson_reconstruction_function<Kernel>;
using Solver = CGAL::Eigen_solver_traits<
    Eigen::ConjugateGradient<CGAL::Eigen_sparse_symmetric_matrix<double>::EigenType>>;

struct StopVisitor {
  ExecutionContext* context;
  void before_insertion() const { throw_if_stopped(context); }
};

// Works in a frame round the cloud's middle; its unit is the box's diagonal at first, at last the spacing, on which
// CGAL's weight of the points (screening) depends.
class Surfacing {
 public:
  Surfacing(std::span<const Vec3> points, ExecutionContext* context) : context_(context) {
    const Box box = box_of(points);
    centre_ = box.middle();
    unit_ = box.diagonal();
    std::vector<Point> places;
    for (const Vec3& p : points) {
      const Vec3 at = (1 / unit_) * (p - centre_);
      places.emplace_back(at.x, at.y, at.z);
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    check(places);
    for (const Point& p : places) cloud_.emplace_back(p, Vector(0, 0, 0));
  }

  CloudSurface surface() {
    CloudSurface found;
    found.lone = leave_out_lone();
    require_enough();
    thin_out();
    found.used = cloud_.size();
    orient();
    require_enough();
    take_unit(mean_spacing());
    found.spacing = unit_;
    found.mesh = zero_set();
    compare(found);
    for (Vec3& p : found.mesh.points) p = unit_ * p + centre_;
    return found;
  }

 private:
  static void check(const std::vector<Point>& places) {
    if (places.size() < kFewest) {
      refuse(std::to_string(places.size()) + " points at different places are too few to tell a surface; " +
             std::to_string(kFewest) + " are needed at least");
    }
    // The widest triangle on the first point: on a line it has no area.
    const Point& first = places.front();
    const auto farthest = [&](const auto& distance) {
      return *std::max_element(places.begin(), places.end(),
                               [&](const Point& a, const Point& b) { return distance(a) < distance(b); });
    };
    const Vector along = farthest([&](const Point& p) { return (p - first).squared_length(); }) - first;
    const auto area = [&](const Point& p) { return CGAL::cross_product(along, p - first); };
    const Vector plane = area(farthest([&](const Point& p) { return area(p).squared_length(); }));
    const auto height = [&](const Point& p) { return std::fabs(plane * (p - first)); };
    if (height(farthest(height)) <= kPlaneCloud * std::sqrt(plane.squared_length()))
      refuse("all points lie in one plane");
  }

  void require_enough() const {
    if (cloud_.size() >= kFewest) return;
    refuse("only " + std::to_string(cloud_.size()) + " points lie near others so that they tell a surface; " +
           std::to_string(kFewest) + " are needed at least");
  }

  auto parameters() const {
    return CGAL::parameters::point_map(Places()).normal_map(Normals()).callback([context = context_](double) {
      throw_if_stopped(context);
      return true;
    });
  }

  double mean_spacing() const {
    return CGAL::compute_average_spacing<Sequential>(cloud_, kApart, parameters());
  }

  std::uint64_t leave_out_lone() {
    const auto lone = CGAL::remove_outliers<Sequential>(
        cloud_, kNeighbours, parameters().threshold_percent(100).threshold_distance(kLone * mean_spacing()));
    const auto count = static_cast<std::uint64_t>(cloud_.end() - lone);
    cloud_.erase(lone, cloud_.end());
    return count;
  }

  // Neighbours within the noise tell no normal: of as many as look like a surface only together few stay.
  void thin_out() {
    std::vector<Point> all, asked;
    for (const Oriented& p : cloud_) all.push_back(p.first);
    const std::size_t count = std::min(kAsked, all.size());
    for (std::size_t i = 0; i < count; ++i) asked.push_back(all[i * all.size() / count]);
    std::vector<std::size_t> scales;
    CGAL::estimate_local_k_neighbor_scales(all, asked, std::back_inserter(scales));
    const std::size_t middle = median(std::move(scales));
    const std::size_t cluster = std::max(middle / kOfScale, (all.size() + kMost - 1) / kMost);
    if (cluster < 2) return;
    if (all.size() / cluster < kFewest) {
      refuse("the points are too noisy to tell a surface: only " + std::to_string(middle) + " of " +
             std::to_string(all.size()) + " together look like a piece of one");
    }
    cloud_.erase(
        CGAL::hierarchy_simplify_point_set(cloud_, parameters().size(static_cast<unsigned>(cluster))),
        cloud_.end());
  }

  // Each part of the cloud by its highest point, which looks upward; parts of few points have no side and go.
  void orient() {
    CGAL::jet_estimate_normals<Sequential>(cloud_, kNeighbours, parameters());
    auto left = cloud_.begin();
    while (cloud_.end() - left > kNeighbours) {
      auto part = CGAL::make_range(left, cloud_.end());
      const auto next = CGAL::mst_orient_normals(part, kNeighbours, parameters());
      if (next == left) break;
      left = next;
    }
    cloud_.erase(left, cloud_.end());
  }

  void take_unit(double unit) {
    unit_ *= unit;
    for (auto& [p, normal] : cloud_) p = Point(p.x() / unit, p.y() / unit, p.z() / unit);
  }

  std::vector<Vec3> places() const {
    std::vector<Vec3> places;
    for (const auto& [p, normal] : cloud_) places.push_back({p.x(), p.y(), p.z()});
    return places;
  }

  Mesh zero_set() const {
    Poisson poisson(cloud_.begin(), cloud_.end(), Places(), Normals());
    if (!poisson.compute_implicit_function(Solver(), StopVisitor{context_}))
      refuse("no surface can be laid through the points");
    const Box box = box_of(places());
    ImplicitMeshOptions cubes;
    const Vec3 sides = box.sides() + 16 * kCube * Vec3{1, 1, 1};
    cubes.spacing = std::max(kCube, cube_root(sides.x * sides.y * sides.z / kMostCubes));
    const Vec3 margin = 8 * cubes.spacing * Vec3{1, 1, 1};
    cubes.low = box.low - margin;
    cubes.high = box.high + margin;
    StopCheck stop(context_);
    // So small that it rules out no cube: of Poisson's function no Lipschitz constant is known.
    const double scale = 1e-9 * cubes.spacing;
    return mesh_zero_set(
        [&](const Vec3& p) {
          stop.did(kOperations);
          return scale * poisson(Point(p.x, p.y, p.z));
        },
        cubes);
  }

  // Throws where the surface is mostly made up.
  void compare(CloudSurface& found) const {
    const std::vector<Vec3> used = places();
    const PointIndex index(used);
    const std::vector<Vec3> samples = surface_samples(found.mesh);
    const auto unseen = std::count_if(samples.begin(), samples.end(),
                                      [&](const Vec3& sample) { return index.nearest(sample) > kFar; });
    found.unseen = static_cast<double>(unseen) / static_cast<double>(samples.size());
    if (found.unseen > kMostUnseen) {
      refuse("the points do not tell where the surface is: they are " + base::rounded(found.spacing, 4) +
             " apart, and no point is near " + base::rounded(100 * found.unseen, 3) +
             " % of the surface through them; more points would help");
    }
    const DistanceToMesh surface(found.mesh);
    double sum = 0;
    for (const Vec3& p : used) sum += surface.nearest(p);
    found.mean_distance = unit_ * sum / static_cast<double>(used.size());
  }

  ExecutionContext* context_;
  Vec3 centre_;
  double unit_ = 1;
  std::vector<Oriented> cloud_;
};

}  // namespace

CloudSurface cloud_surface(std::span<const Vec3> points, ExecutionContext* context) {
  return Surfacing(points, context).surface();
}

}  // namespace affskel::core
