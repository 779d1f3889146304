// With P = sqrt(E / max E): lambda_E = 2 P lambda_P and grad E = 2 P grad P, in units of max E and of the
// spacing, so that s = -lambda_P P / (2 |grad P|^2).
#include "core/ridge/ridge_crossings.h"

#include <algorithm>
#include <cmath>

#include "core/base/matrix3.h"
#include "core/base/require.h"
#include "core/base/scaled_to_unit.h"
#include "core/base/symmetric_eigen.h"

namespace affskel::core {
namespace {

constexpr double kMaxStrength = 1000;  // where the gradient vanishes, s has no bound

// The least eigenvalue at a sample point; 0 and no direction where it cannot give a ridge.
struct PointRidge {
  std::array<float, 3> direction{};  // e, unit
  float least = 0;                   // lambda_1
  float ratio = 0;                   // lambda_2 / lambda_1
  float roundness = 0;               // lambda_3 / lambda_1
};

Vec3 vector_of(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

double strength_of(double least, double value, const Vec3& gradient) {
  const double square = dot(gradient, gradient), turn = -least * value;
  return turn < 2 * kMaxStrength * square ? 0.5 * turn / square : kMaxStrength;
}

PointRidge ridge_at(const PointDerivatives& point, double min_strength) {
  const auto& h = point.hessian;
  double largest = 0, squares = 0;
  for (std::size_t n = 0; n < 6; ++n) {
    const double entry = std::abs(static_cast<double>(h[n]));
    largest = std::max(largest, entry);
    squares += (n == 0 || n == 3 || n == 5 ? 1 : 2) * entry * entry;
  }
  // -lambda_1 is at most the Frobenius norm: most points need no eigenvalues.
  const Vec3 gradient = vector_of(point.gradient);
  if (largest == 0 ||
      strength_of(-std::sqrt(squares), static_cast<double>(point.value), gradient) < 0.25 * min_strength)
    return {};
  const auto scaled = [&](std::size_t n) { return static_cast<double>(h[n]) / largest; };
  const SymmetricEigen eigen =
      symmetric_eigen({Vec3{scaled(0), scaled(1), scaled(2)}, Vec3{scaled(1), scaled(3), scaled(4)},
                       Vec3{scaled(2), scaled(4), scaled(5)}});
  if (eigen.values[2] >= 0) return {};
  const Vec3& e = eigen.vectors[2];
  return {{static_cast<float>(e.x), static_cast<float>(e.y), static_cast<float>(e.z)},
          static_cast<float>(eigen.values[2] * largest),
          static_cast<float>(eigen.values[1] / eigen.values[2]),
          static_cast<float>(eigen.values[0] / eigen.values[2])};
}

class Finder {
 public:
  Finder(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
         std::span<const PointDerivatives> derivatives, const RidgeCrossingOptions& options)
      : lattice_(lattice),
        parts_(parts),
        field_(field),
        derivatives_(derivatives),
        options_(options),
        to_mesh_(inverse_transposed(frame_matrix(lattice))) {
    const double cell = lattice.spacing * lattice.spacing * lattice.spacing;
    for (std::uint32_t part = 0; part < parts.count(); ++part)
      least_erosion_.push_back(options.min_erosion * cell * parts.points(part));
    ridges_.reserve(derivatives.size());
    for (const PointDerivatives& point : derivatives)
      ridges_.push_back(ridge_at(point, options.min_strength));
  }

  std::vector<RidgeCrossing> run() const {
    std::vector<RidgeCrossing> result;
    for_each_edge(lattice_, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto& place) {
      const PointRidge &at_x = ridges_[x], &at_y = ridges_[y];
      if (at_x.least >= 0 || at_y.least >= 0) return;
      const Vec3 e_x = vector_of(at_x.direction);
      const Vec3 e_y = vector_of(at_y.direction);
      const double turn = dot(e_x, e_y) < 0 ? -1 : 1;
      const double slope_x = dot(e_x, vector_of(derivatives_[x].gradient));
      const double slope_y = turn * dot(e_y, vector_of(derivatives_[y].gradient));
      if ((slope_x < 0) == (slope_y < 0)) return;
      const double t = slope_x / (slope_x - slope_y);
      const RidgeCrossing crossing = at({x, axis, place}, y, t, (1 - t) * e_x + (t * turn) * e_y);
      if (crossing.strength >= options_.min_strength &&
          crossing.erosion >= least_erosion_[parts_.of_point(x)])
        result.push_back(crossing);
    });
    return result;
  }

 private:
  // |grad_x E| = |F^-T g| for a gradient g in the frame: the area of the section.
  double area(std::uint32_t point) const {
    const Vec3& g = field_.gradient[point];
    return std::ldexp(norm(to_mesh_ * scaled_to_unit(g)), largest_exponent(g));
  }

  RidgeCrossing at(const LatticeEdge& edge, std::uint32_t upper, double t, const Vec3& across) const {
    const std::uint32_t x = edge.point, y = upper;
    const auto between = [t](double low, double high) { return (1 - t) * low + t * high; };
    RidgeCrossing crossing;
    crossing.edge = edge;
    std::array<double, 3> u{};
    for (std::size_t k = 0; k < 3; ++k) u[k] = edge.place[k];
    u[edge.axis] += t;
    crossing.position = field_.spacing * Vec3{u[0], u[1], u[2]};
    crossing.normal = (1 / norm(across)) * across;
    crossing.erosion = between(field_.erosion[x], field_.erosion[y]);
    const Vec3 g = (1 - t) * vector_of(derivatives_[x].gradient) + t * vector_of(derivatives_[y].gradient);
    const double least =
        between(static_cast<double>(ridges_[x].least), static_cast<double>(ridges_[y].least));
    crossing.strength = strength_of(
        least,
        between(static_cast<double>(derivatives_[x].value), static_cast<double>(derivatives_[y].value)), g);
    crossing.ratio = between(static_cast<double>(ridges_[x].ratio), static_cast<double>(ridges_[y].ratio));
    crossing.roundness =
        between(static_cast<double>(ridges_[x].roundness), static_cast<double>(ridges_[y].roundness));
    crossing.area = between(area(x), area(y));
    const double width =
        between(static_cast<double>(derivatives_[x].width), static_cast<double>(derivatives_[y].width));
    // grad P one width away along e is g -+ lambda width e, to first order.
    const Vec3 rise = (-least * width) * crossing.normal;
    crossing.normal_a = unit(g + rise);
    crossing.normal_b = unit(g - rise);
    return crossing;
  }

  static Vec3 unit(const Vec3& v) {
    const double length = norm(v);
    return length > 0 ? (1 / length) * v : Vec3{};
  }

  const Lattice& lattice_;
  const SolidParts& parts_;
  const FrameField& field_;
  std::span<const PointDerivatives> derivatives_;
  const RidgeCrossingOptions& options_;
  Matrix3 to_mesh_;                    // F^-T
  std::vector<double> least_erosion_;  // per part
  std::vector<PointRidge> ridges_;     // per sample point
};

}  // namespace

std::vector<RidgeCrossing> ridge_crossings(const Lattice& lattice, const SolidParts& parts,
                                           const FrameField& field,
                                           std::span<const PointDerivatives> derivatives,
                                           const RidgeCrossingOptions& options) {
  require_within(options.min_strength, 1e-6, kMaxStrength,
                 "the least strength of a ridge must lie between 1e-6 and 1000");
  require_within(options.min_erosion, 0, 1, "the least share of E must lie between 0 and 1");
  return Finder(lattice, parts, field, derivatives, options).run();
}

}  // namespace affskel::core
