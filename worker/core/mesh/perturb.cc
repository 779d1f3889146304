#include "core/mesh/perturb.h"

#include <cmath>
#include <string>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/base/plain_math.h"
#include "core/base/split_mix64.h"
#include "core/mesh/coincident_points.h"

namespace affskel::core {
namespace {

// Independent numbers of mean 0 and variance 1.
class Gaussian {
 public:
  explicit Gaussian(std::uint64_t seed) : random_(seed) {}

  double next() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double u = 0, v = 0, square = 0;
    do {
      u = random_.symmetric();
      v = random_.symmetric();
      square = u * u + v * v;
    } while (square >= 1 || square == 0);
    const double factor = std::sqrt(-2 * plain_log(square) / square);
    spare_ = factor * v;
    has_spare_ = true;
    return factor * u;
  }

 private:
  SplitMix64 random_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace

Mesh perturb(const Mesh& mesh, const PerturbOptions& options) {
  if (!(options.sigma >= 0) || !std::isfinite(options.sigma)) {
    refuse("the noise must be a finite number >= 0, not " + base::to_text(options.sigma));
  }
  const std::vector<std::uint32_t> first = first_coincident_point(mesh.points);
  Gaussian gaussian(options.seed);
  Mesh result = mesh;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (first[v] < v) {
      result.points[v] = result.points[first[v]];
      continue;
    }
    const double x = gaussian.next(), y = gaussian.next(), z = gaussian.next();
    const Vec3 moved = mesh.points[v] + options.sigma * Vec3{x, y, z};
    if (!is_finite(moved)) {
      refuse("the noise takes vertex " + std::to_string(v) + " out of the range of a double");
    }
    result.points[v] = moved;
  }
  return result;
}

}  // namespace affskel::core
