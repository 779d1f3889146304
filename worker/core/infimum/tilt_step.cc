#include "core/infimum/tilt_step.h"

#include <algorithm>

namespace affskel::core {
namespace {

// Of t.  Longer ones meet more saddles than they spare steps.
constexpr double kLongestStep = 0.12;
constexpr double kFlat = 1e-12;   // of the largest second derivative: a lesser one is none
constexpr double kRaised = 1e-3;  // likewise, what takes its place

Flat times(double s, const Flat& a) {
  return {s * a[0], s * a[1]};
}

double bend(const Hessian& h, const Flat& t) {
  return h[0] * t[0] * t[0] + 2 * h[1] * t[0] * t[1] + h[2] * t[1] * t[1];
}

TiltStep step_along(const Stand& at, Flat t) {
  const double length = norm(t);
  if (length > kLongestStep) t = times(kLongestStep / length, t);
  return {t, -(dot(at.gradient, t) + 0.5 * bend(at.hessian, t))};
}

}  // namespace

TiltStep free_step(const Stand& at) {
  const auto& [a, b, c] = at.hessian;
  const double mean = 0.5 * (a + c), spread = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
  const double least = mean - spread, most = std::max(std::abs(mean) + spread, kFlat * at.area);
  const double more = least > kFlat * most ? 0 : kRaised * most - least;
  const double aa = a + more, cc = c + more, det = aa * cc - b * b;
  const Flat& g = at.gradient;
  if (det > 0) return step_along(at, {-(cc * g[0] - b * g[1]) / det, -(aa * g[1] - b * g[0]) / det});
  const double size = norm(g);
  return size > 0 ? step_along(at, times(-kLongestStep / size, g)) : TiltStep{};
}

TiltStep step_round(const Stand& at, const Flat& z) {
  const double length = norm(z);
  const Flat e = {-z[1] / length, z[0] / length};
  const double first = dot(at.gradient, e), second = bend(at.hessian, e);
  if (first == 0) return {};
  const bool convex = second * kLongestStep > std::abs(first);
  return step_along(at, times(convex ? -first / second : first > 0 ? -kLongestStep : kLongestStep, e));
}

}  // namespace affskel::core
