#include "core/erosion/directions.h"

#include <stdexcept>

#include "base/number_text.h"
#include "base/quoted.h"
#include "core/base/error.h"
#include "core/base/split_mix64.h"
#include "core/mesh/geodesic_sphere.h"

namespace affskel::core {
namespace {

using Part = base::DirectionSetPart;

std::vector<Part> parse(std::string_view spec) {
  try {
    return base::parse_direction_set(spec);
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
}

// As unit(), but for the last bits, which all fields depend on.  Scaled first: squares of tiny normals would
// underflow.
Vec3 direction_of(const Vec3& v) {
  const double big = largest_component(v);
  if (big == 0) return {};
  const Vec3 w = v / big;
  return w / norm(w);
}

void add_face(const Vec3& a, const Vec3& b, const Vec3& c, std::uint64_t f, DirectionSet& set) {
  const auto n = static_cast<double>(f);
  const auto at = [&](std::uint64_t i, std::uint64_t j) {
    const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
    return direction_of(((1 - u - v) * a) + ((u * b) + (v * c)));
  };
  for (std::uint64_t i = 0; i < f; ++i) {
    for (std::uint64_t j = 0; i + j < f; ++j) {
      const Vec3 p = at(i, j), q = at(i + 1, j), r = at(i, j + 1);
      set.push_back(-direction_of(cross(q - p, r - p)));
      if (i + j + 1 == f) continue;
      const Vec3 s = at(i + 1, j + 1);
      set.push_back(-direction_of(cross(s - q, r - q)));
    }
  }
}

std::uint64_t sphere_frequency(std::uint64_t count) {
  std::uint64_t f = 1;
  while (20 * f * f < count) ++f;
  return f;
}

void add_sphere(std::uint64_t count, DirectionSet& set) {
  const std::uint64_t f = sphere_frequency(count);
  const Mesh coarse = icosahedron();
  for (const Triangle& t : coarse.triangles) {
    add_face(coarse.points[t[0]], coarse.points[t[1]], coarse.points[t[2]], f, set);
  }
}

void add_random(std::uint64_t count, std::uint64_t seed, DirectionSet& set) {
  SplitMix64 random(seed);
  for (std::uint64_t i = 0; i < count;) {
    const Vec3 v{random.symmetric(), random.symmetric(), random.symmetric()};
    const double square = dot(v, v);
    if (square > 1 || square < 1e-4) continue;
    set.push_back(direction_of(v));
    ++i;
  }
}

// Normals from `first` on: from the frame's coordinates to the mesh's.
void map_from_frame(const Matrix3& frame, std::size_t first, DirectionSet& set) {
  if (frame == kIdentity3) return;  // not a bit may change
  const Matrix3 map = inverse_transposed(frame);
  for (std::size_t i = first; i < set.size(); ++i) set[i] = direction_of(map * set[i]);
}

void require_affordable(const Solid& solid, const std::vector<Part>& parts, std::string_view spec,
                        const DirectionOptions& options) {
  double total = 0;
  for (const Part& part : parts) {
    total += part.kind == Part::Kind::kTriangles ? static_cast<double>(solid.mesh.triangles.size())
                                                 : static_cast<double>(part.count);
  }
  if (total > static_cast<double>(options.max_directions)) {
    throw CoreError(CoreError::Code::kLimit, "directions " + base::quoted(spec, 100) + ": " +
                                                 base::rounded(total, 10) + " directions; at most " +
                                                 std::to_string(options.max_directions) + " are supported");
  }
}

}  // namespace

void check_directions(const Solid& solid, std::string_view spec, const DirectionOptions& options) {
  require_affordable(solid, parse(spec), spec, options);
}

DirectionSet make_directions(const Solid& solid, std::string_view spec, const DirectionOptions& options) {
  const std::vector<Part> parts = parse(spec);
  require_affordable(solid, parts, spec, options);
  DirectionSet set;
  for (const Part& part : parts) {
    const std::size_t before = set.size();
    switch (part.kind) {
      case Part::Kind::kTriangles:
        for (const Triangle& t : solid.mesh.triangles)
          set.push_back(-direction_of(twice_area(solid.mesh, t)));
        break;
      case Part::Kind::kSphere:
        add_sphere(part.count, set);
        break;
      case Part::Kind::kRandom:
        add_random(part.count, part.seed, set);
        break;
    }
    if (part.kind != Part::Kind::kTriangles) map_from_frame(options.frame, before, set);
  }
  return set;
}

}  // namespace affskel::core
