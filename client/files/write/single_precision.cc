#include "client/files/write/single_precision.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/number_text.h"
#include "client/base/error.h"
#include "core/mesh/box.h"

namespace affskel::client {
namespace {

using core::Vec3;

constexpr const char* kInstead = "; write .off, .ply, .obj or .vtp, which hold double precision";

std::string text_of(const Vec3& p) {
  return "(" + base::rounded(p.x, 9) + ", " + base::rounded(p.y, 9) + ", " + base::rounded(p.z, 9) + ")";
}

std::string text_of(const core::Box& extent) {
  return "the surface reaches from " + text_of(extent.low) + " to " + text_of(extent.high);
}

Vec3 single(const Vec3& p) {
  return {double{static_cast<float>(p.x)}, double{static_cast<float>(p.y)}, double{static_cast<float>(p.z)}};
}

// Areas in units of the extent, so that they neither vanish nor overflow.
class Areas {
 public:
  explicit Areas(const core::Box& extent) {
    const double side = extent.longest_side();
    exponent_ = side > 0 ? -std::ilogb(side) : 0;
  }

  double operator()(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return 0.5 * core::norm(core::cross(scaled(b - a), scaled(c - a)));
  }

 private:
  Vec3 scaled(const Vec3& v) const {
    return {std::ldexp(v.x, exponent_), std::ldexp(v.y, exponent_), std::ldexp(v.z, exponent_)};
  }

  int exponent_;
};

void check_range(const core::Box& extent) {
  constexpr double kMaxFloat = std::numeric_limits<float>::max();
  for (const Vec3& p : {extent.low, extent.high}) {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(p[k]) <= kMaxFloat) continue;
      throw ClientError(ExitCode::kLimit, ".stl holds single precision, coordinates up to 3.4e38; " +
                                              text_of(extent) + kInstead);
    }
  }
}

// How many triangles become flat in single precision.  0 also when these are mere slivers: their area is
// negligible, and every vertex keeps another triangle, so that no part of the surface is lost.
std::size_t count_spoilt(const core::Mesh& mesh, const Areas& area) {
  double total = 0, lost = 0;
  std::size_t flat = 0;
  std::vector<bool> stays(mesh.points.size()), flattened(mesh.points.size());
  for (const core::Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    const double before = area(a, b, c);
    total += before;
    if (before == 0) continue;
    const bool is_flat = area(single(a), single(b), single(c)) == 0;
    for (const std::uint32_t corner : t) (is_flat ? flattened : stays)[corner] = true;
    if (!is_flat) continue;
    lost += before;
    ++flat;
  }
  bool slivers = lost <= 1e-6 * total;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) slivers = slivers && (stays[v] || !flattened[v]);
  return slivers ? 0 : flat;
}

}  // namespace

void check_fits_stl(const core::Mesh& mesh) {
  if (mesh.triangles.empty()) return;
  const core::Box extent = core::box_of(mesh);
  check_range(extent);
  const std::size_t flat = count_spoilt(mesh, Areas(extent));
  if (flat == 0) return;
  throw ClientError(ExitCode::kLimit, ".stl holds single precision, about 7 digits; " + std::to_string(flat) +
                                          " of " + std::to_string(mesh.triangles.size()) +
                                          " triangles would become flat, because " + text_of(extent) +
                                          kInstead + ", or move or scale it first");
}

}  // namespace affskel::client
