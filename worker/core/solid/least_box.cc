// CGAL's oriented bounding box (Chang, Gorissen & Melchior 2011) searches by evolution, here from several
// fixed seeds.  Each result is rounded to 2^-26, which takes away what libm and instruction set did to it,
// and goes on to the nearest local minimum (shrink_box).  The least of these counts, within 1e-9 the first.
#include "core/solid/least_box.h"

#include <CGAL/Aff_transformation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/convex_hull_3.h>
#include <CGAL/optimal_bounding_box.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "core/solid/shrink_box.h"

namespace affskel::core {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr unsigned kSearches = 5;
constexpr double kTie = 1e-9;

// CGAL's search draws from this thread's generator: seeds it, and puts it back as it was.
class FixedSeed {
 public:
  explicit FixedSeed(unsigned seed) : before_(CGAL::get_default_random()) {
    CGAL::get_default_random() = CGAL::Random(seed);
  }
  ~FixedSeed() { CGAL::get_default_random() = before_; }
  FixedSeed(const FixedSeed&) = delete;
  FixedSeed& operator=(const FixedSeed&) = delete;

 private:
  CGAL::Random before_;
};

double rounded(double component) {
  return std::ldexp(std::nearbyint(std::ldexp(component, 26)), -26);
}

std::vector<Kernel::Point_3> hull_points(const Mesh& mesh) {
  std::vector<Kernel::Point_3> points, hull;
  points.reserve(mesh.points.size());
  for (const Vec3& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
  CGAL::extreme_points_3(points, std::back_inserter(hull));
  return hull;
}

Matrix3 found_from(unsigned seed, const std::vector<Kernel::Point_3>& points) {
  const FixedSeed fixed(seed);
  CGAL::Aff_transformation_3<Kernel> turn(CGAL::IDENTITY);
  CGAL::oriented_bounding_box(points, turn, CGAL::parameters::use_convex_hull(false));
  const auto axis = [&](int k) {
    return Vec3{rounded(turn.m(k, 0)), rounded(turn.m(k, 1)), rounded(turn.m(k, 2))};
  };
  return {axis(0), axis(1), axis(2)};
}

}  // namespace

Matrix3 least_box_axes(const Mesh& mesh, ExecutionContext* context) {
  const std::vector<Kernel::Point_3> hull = hull_points(mesh);
  std::vector<Vec3> points;
  for (const Kernel::Point_3& p : hull) points.push_back({p.x(), p.y(), p.z()});
  FittedBox least = shrink_box(points, kIdentity3, context);
  for (unsigned seed = 1; seed <= kSearches; ++seed) {
    throw_if_stopped(context);
    const FittedBox box = shrink_box(points, found_from(seed, hull), context);
    if (box.volume < (1 - kTie) * least.volume) least = box;
  }
  return least.axes;
}

}  // namespace affskel::core
