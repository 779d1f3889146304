// Why kurtoses.  The frame kAffine maximises the contrast sum (k - 3)^2 of the kurtoses k = E[(u.w)^4] along
// the axes u, with w = C^(-1/2) (x - centroid).  Noise on the vertices of human bodies (0.5 to 1 % of the box
// diagonal) turns its rotation by a seventh of what it turns the eigenvectors of E[|w|^2 w w^T] (Cardoso
// 1989), in the median.  Two maxima of nearly the same height may still change places, and the axes then
// jump.
//
// Signs, for all kinds but kAxis.  The third moments along the first two axes are > 0, and the third axis
// makes them right-handed.  For kAffine the third moments are > 0 along all three axes, so that the order of
// two axes of about the same kurtosis, as mirror-symmetric solids have them, does not show; if the axes are
// then left-handed, the two whose kurtoses differ least change places.  An axis whose third moment vanishes
// (below 1e-6 of that of its length) points to where its largest component is > 0; for kAffine, the last such
// axis makes the axes right-handed.  Order and signs map the lattice onto itself.
//
// Ties.  What differs by less than 1e-6 of the largest counts as equal.  Equal sides or kurtoses: the axis
// nearer to x comes first, then the one nearer to y.  Two equal eigenvalues (kPca): the first of their axes
// is the projection onto their plane of the coordinate axis nearest to it.  Three: the coordinate axes are
// taken.  Where the maximum of kAffine is not unique, independent_axes chooses by the coordinate axes of w: a
// box, a ball and an ellipsoid parallel to the mesh's axes have F = s C^(1/2).  That choice can be reproduced
// but does not go along with a map M: the frame of M V is then M F times a rotation that leaves the contrast
// as it is, to 1e-6.
#include "core/solid/solid_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/axis_choice.h"
#include "core/base/error.h"
#include "core/base/plain_math.h"
#include "core/base/symmetric_eigen.h"
#include "core/mesh/box.h"
#include "core/solid/independent_axes.h"
#include "core/solid/least_box.h"
#include "core/solid/moments.h"

namespace affskel::core {
namespace {

// Orthonormal axes with what they are ordered by.
struct OrderedAxes {
  std::array<double, 3> size{};
  Matrix3 axes{};
};

// A plane of equal eigenvalues determines no axes in it.
Matrix3 with_ties_resolved(const OrderedAxes& ordered) {
  const std::array<double, 3>& s = ordered.size;
  const bool first = s[0] - s[1] <= kAxisTie * s[0], last = s[1] - s[2] <= kAxisTie * s[0];
  if (first && last) return kIdentity3;
  if (!first && !last) return ordered.axes;
  const Vec3& alone = ordered.axes[first ? 2 : 0];
  const auto [a, b] = plane_axes(alone);
  if (first) return {a, b, alone};
  return {alone, a, b};
}

// Whether the first of the largest components is < 0.
bool points_back(const Vec3& axis) {
  const double largest = largest_component(axis);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) >= (1 - kAxisTie) * largest) return axis[k] < 0;
  }
  return false;
}

bool is_before(const Vec3& a, const Vec3& b) {
  const double x = std::abs(a.x) - std::abs(b.x), y = std::abs(a.y) - std::abs(b.y);
  return std::abs(x) > kAxisTie ? x > 0 : y > kAxisTie;
}

// Of equal ones the one nearer to x comes first, then the one nearer to y.
OrderedAxes descending(OrderedAxes a) {
  const double tie = kAxisTie * *std::max_element(a.size.begin(), a.size.end());
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{0}}) {
    const double larger = a.size[k + 1] - a.size[k];
    if (larger > tie || (larger >= -tie && is_before(a.axes[k + 1], a.axes[k]))) {
      std::swap(a.size[k], a.size[k + 1]);
      std::swap(a.axes[k], a.axes[k + 1]);
    }
  }
  return a;
}

class Frame {
 public:
  explicit Frame(const Mesh& mesh) : mesh_(mesh), moments_(solid_moments(mesh)) {}

  Matrix3 principal() const {
    const SymmetricEigen eigen = symmetric_eigen(moments_.covariance);
    return oriented(with_ties_resolved({eigen.values, eigen.vectors}));
  }

  Matrix3 least_box(ExecutionContext* context) const {
    const Matrix3 axes = least_box_axes(mesh_, context);
    const Vec3 sides = box_of(mesh_.points, axes).sides();
    return oriented(descending({{sides.x, sides.y, sides.z}, axes}).axes);
  }

  Matrix3 affine() const {
    SymmetricEigen eigen = symmetric_eigen(moments_.covariance);
    // Regions that are turned inside out count negatively, and badly folded noise has many of them.  The
    // vertices' covariance is as covariant, and never negative.
    if (!(eigen.values[2] > 0)) eigen = symmetric_eigen(vertex_covariance());
    if (!(eigen.values[2] > 0)) {
      refuse("the solid is too flat for an affine frame");
    }
    Matrix3 root{}, whitening{};  // C^(1/2) and C^(-1/2)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = std::sqrt(eigen.values[k]);
      const Vec3& e = eigen.vectors[k];
      root = root + outer(e, length * e);
      whitening = whitening + Matrix3{e.x / length * e, e.y / length * e, e.z / length * e};
    }
    const IndependentAxes found =
        independent_axes(fourth_moments(mesh_, moments_.volume, moments_.centroid, whitening));
    const Matrix3 axes = unmirrored(descending({found.kurtosis, found.axes}), whitening);
    const Matrix3 frame = root * axes;
    return (1 / cube_root(determinant(frame))) * frame;
  }

 private:
  Matrix3 vertex_covariance() const {
    const double share = 1 / static_cast<double>(mesh_.points.size());
    Vec3 mean;
    for (const Vec3& p : mesh_.points) mean = mean + share * p;
    Matrix3 covariance{};
    for (const Vec3& p : mesh_.points) {
      const Vec3 q = p - mean;
      covariance = covariance + outer(q, share * q);
    }
    return covariance;
  }

  // Turns the axis to where the third moment of w = whitening (x - centroid), whitening symmetric, is > 0.
  // Returns false when it vanishes.
  bool orient(Vec3& axis, const Matrix3& whitening) const {
    const Vec3 along = whitening * axis;
    const double third = third_moment(mesh_, moments_.volume, moments_.centroid, along);
    const double variance = dot(along, moments_.covariance * along);
    const bool vanishes = std::abs(third) <= kAxisTie * variance * std::sqrt(variance);
    if (vanishes ? points_back(axis) : third < 0) axis = -axis;
    return !vanishes;
  }

  // The signs of the first two by third moments; the third axis makes them right-handed.
  Matrix3 oriented(Matrix3 axes) const {
    for (std::size_t k = 0; k < 2; ++k) orient(axes[k], kIdentity3);
    axes[2] = unit(cross(axes[0], axes[1]));
    return axes;
  }

  // All signs by third moments.  What is left-handed then is put right by the last axis whose third moment
  // vanishes; if none does, by the order of the two axes that it decides the least.
  Matrix3 unmirrored(OrderedAxes a, const Matrix3& whitening) const {
    std::size_t loose = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!orient(a.axes[k], whitening)) loose = k;
    }
    if (determinant(a.axes) > 0) return a.axes;
    const std::size_t closest = a.size[0] - a.size[1] < a.size[1] - a.size[2] ? 0 : 1;
    if (loose < 3) {
      a.axes[loose] = -a.axes[loose];
    } else {
      std::swap(a.axes[closest], a.axes[closest + 1]);
    }
    return a.axes;
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
  refuse("frame '" + std::string(name.substr(0, 40)) + "': expected axis, pca, obb or affine");
}

Matrix3 solid_frame(const Solid& solid, FrameKind kind, ExecutionContext* context) {
  switch (kind) {
    case FrameKind::kAxis:
      break;
    case FrameKind::kPca:
      return Frame(solid.mesh).principal();
    case FrameKind::kObb:
      return Frame(solid.mesh).least_box(context);
    case FrameKind::kAffine:
      return Frame(solid.mesh).affine();
  }
  return kIdentity3;
}

}  // namespace affskel::core
