#include "core/solid_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/cube_root.h"
#include "core/error.h"
#include "core/least_box.h"
#include "core/moments.h"
#include "core/symmetric_eigen.h"

namespace affskel::core {
namespace {

// Of the largest: what counts as equal, or as 0.
constexpr double kTie = 1e-6;

Vec3 unit(const Vec3& v) {
  return (1 / norm(v)) * v;
}

// Orthonormal axes with what they are ordered by, descending.
struct OrderedAxes {
  std::array<double, 3> size{};
  Matrix3 axes{};
};

// The axes of the plane across `normal`: the nearest coordinate axis first.
std::array<Vec3, 2> plane_axes(const Vec3& normal) {
  const std::array<double, 3> away = {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const double least = *std::min_element(away.begin(), away.end());
  std::size_t nearest = 0;
  while (away[nearest] > least + kTie) ++nearest;
  const Vec3& axis = kIdentity3[nearest];
  const Vec3 first = unit(axis - dot(axis, normal) * normal);
  return {first, unit(cross(normal, first))};
}

// A plane of equal eigenvalues determines no axes in it.
Matrix3 with_ties_resolved(const OrderedAxes& ordered) {
  const std::array<double, 3>& s = ordered.size;
  const bool first = s[0] - s[1] <= kTie * s[0], last = s[1] - s[2] <= kTie * s[0];
  if (first && last) return kIdentity3;
  if (!first && !last) return ordered.axes;
  const Vec3& alone = ordered.axes[first ? 2 : 0];
  const auto [a, b] = plane_axes(alone);
  if (first) return {a, b, alone};
  return {alone, a, b};
}

// Whether the first of the largest components is < 0.
bool points_back(const Vec3& axis) {
  const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) >= (1 - kTie) * largest) return axis[k] < 0;
  }
  return false;
}

bool is_before(const Vec3& a, const Vec3& b) {
  const double x = std::abs(a.x) - std::abs(b.x), y = std::abs(a.y) - std::abs(b.y);
  return std::abs(x) > kTie ? x > 0 : y > kTie;
}

class Frame {
 public:
  explicit Frame(const Mesh& mesh) : mesh_(mesh), moments_(solid_moments(mesh)) {}

  Matrix3 principal() const {
    const SymmetricEigen eigen = symmetric_eigen(moments_.covariance);
    return oriented(with_ties_resolved({eigen.values, eigen.vectors}), kIdentity3);
  }

  Matrix3 least_box() const { return oriented(longest_first(least_box_axes(mesh_)), kIdentity3); }

  Matrix3 affine() const {
    const SymmetricEigen eigen = symmetric_eigen(moments_.covariance);
    if (!(eigen.values[2] > 0)) {
      throw CoreError(CoreError::Code::kBadInput, "the solid is too flat for an affine frame");
    }
    Matrix3 root{}, whitening{};  // C^(1/2) and C^(-1/2)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = std::sqrt(eigen.values[k]);
      const Vec3& e = eigen.vectors[k];
      root = sum(root, {length * e.x * e, length * e.y * e, length * e.z * e});
      whitening = sum(whitening, {e.x / length * e, e.y / length * e, e.z / length * e});
    }
    const SymmetricEigen fourth =
        symmetric_eigen(fourth_moment(mesh_, moments_.volume, moments_.centroid, whitening));
    const Matrix3 axes = oriented(with_ties_resolved({fourth.values, fourth.vectors}), whitening);
    const Matrix3 frame = root * axes;
    return (1 / cube_root(determinant(frame))) * frame;
  }

 private:
  static Matrix3 sum(const Matrix3& a, const Matrix3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

  // Of equal sides the one nearer to x comes first, then the one nearer to y.
  Matrix3 longest_first(const Matrix3& axes) const {
    OrderedAxes box{{}, axes};
    for (std::size_t k = 0; k < 3; ++k) box.size[k] = side(axes[k]);
    const double tie = kTie * *std::max_element(box.size.begin(), box.size.end());
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{0}}) {
      const double longer = box.size[k + 1] - box.size[k];
      if (longer > tie || (longer >= -tie && is_before(box.axes[k + 1], box.axes[k]))) {
        std::swap(box.size[k], box.size[k + 1]);
        std::swap(box.axes[k], box.axes[k + 1]);
      }
    }
    return box.axes;
  }

  double side(const Vec3& axis) const {
    double low = dot(axis, mesh_.points.front()), high = low;
    for (const Vec3& p : mesh_.points) {
      low = std::min(low, dot(axis, p));
      high = std::max(high, dot(axis, p));
    }
    return high - low;
  }

  // Signs by the third moments of w = whitening (x - centroid), whitening symmetric; the third axis makes
  // them right-handed.
  Matrix3 oriented(Matrix3 axes, const Matrix3& whitening) const {
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3 along = whitening * axes[k];
      const double third = third_moment(mesh_, moments_.volume, moments_.centroid, along);
      const double variance = dot(along, moments_.covariance * along);
      const bool vanishes = std::abs(third) <= kTie * variance * std::sqrt(variance);
      if (vanishes ? points_back(axes[k]) : third < 0) axes[k] = -axes[k];
    }
    axes[2] = unit(cross(axes[0], axes[1]));
    return axes;
  }

  const Mesh& mesh_;
  Moments moments_;
};

}  // namespace

FrameKind parse_frame(std::string_view name) {
  if (name == "axis") return FrameKind::kAxis;
  if (name == "pca") return FrameKind::kPca;
  if (name == "obb") return FrameKind::kObb;
  if (name == "affine") return FrameKind::kAffine;
  throw CoreError(CoreError::Code::kBadInput,
                  "frame '" + std::string(name.substr(0, 40)) + "': expected axis, pca, obb or affine");
}

Matrix3 solid_frame(const Solid& solid, FrameKind kind) {
  switch (kind) {
    case FrameKind::kAxis:
      break;
    case FrameKind::kPca:
      return Frame(solid.mesh).principal();
    case FrameKind::kObb:
      return Frame(solid.mesh).least_box();
    case FrameKind::kAffine:
      return Frame(solid.mesh).affine();
  }
  return kIdentity3;
}

}  // namespace affskel::core
