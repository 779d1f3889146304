#include "core/collapse/sheet_fronts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace affskel::core {
namespace {

// The depth grows by 1 a spacing off the medial axis, in the mean of cubes on both sides of it by less: by 0.71 along the
// bisector of a right angle.  Distances on a lattice are off by as much as that leaves room for.
constexpr double kOffAxis = 0.8;

// A square goes with the front in the direction of the front: along a diagonal of space that advances 0.58 along an axis.
constexpr double kOnwards = 0.6;

// A sheet turns the slopes of the depth, of which sheet_normal() sums four, by at least so much.
constexpr double kSheet = 0.3;

// The least time of a front, of which is only known that it stands there.
constexpr float kStands = 1e-6F;

// How far a sheet's normal lets one get along it by a step in a direction, of which the normal has so much.
double advance(double normal) {
  return std::sqrt(std::max(0.0, 1 - normal * normal));
}

// When a front of unit speed on a sheet leaves a square that it enters by one side at a and by one beside that at
// b: |grad T| = 1 along the sheet, by differences (Sethian, A fast marching level set method, 1996).  u, v: what the
// sheet's normal has along the ways that a and b lead in; all 0 where there is no sheet.
double front_time(double a, double b, double u, double v) {
  const double A = 1 - v * v, B = u * v, C = 1 - u * u;  // of (T - a)^2, 2 (T - a)(T - b), (T - b)^2
  const double later = std::max(a, b), p = later - a, q = later - b;
  // With t = T - later.
  const double square = A + 2 * B + C, half = A * p + B * (p + q) + C * q;
  const double rest = A * p * p + 2 * B * p * q + C * q * q - (1 - u * u - v * v);
  const double root = half * half - square * rest;
  const double from_beside = std::max(a, b + advance(v));
  if (square <= 0 || root < 0) return from_beside;
  const double t = (std::sqrt(root) - half) / square;
  const bool from_both = t >= 0 && A * (t + p) + B * (t + q) >= 0 && B * (t + p) + C * (t + q) >= 0;
  return from_both ? std::min(later + t, from_beside) : from_beside;
}

}  // namespace

SheetFronts::SheetFronts(const DualComplex& complex, std::span<const float> depth)
    : complex_(complex), depth_(depth), reached_(complex, DualComplex::places_of_dimension(1), 0) {}

// How fast the depth grows at a cube, by differences over two spacings.
Vec3 SheetFronts::slope_at(std::uint32_t cube) const {
  Vec3 slope;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t lower = complex_.neighbour(cube, axis, 0), upper = complex_.neighbour(cube, axis, 2);
    const float rise = depth_[upper == kNone ? cube : upper] - depth_[lower == kNone ? cube : lower];
    slope[axis] = static_cast<double>(lower != kNone && upper != kNone ? 0.5F * rise : rise);
  }
  return slope;
}

void SheetFronts::end_wave() {
  for (const Cell edge : standing_) reached_[edge] = std::max(std::abs(reached_[edge]), kStands);
  standing_.clear();
}

float SheetFronts::cross(Cell edge, Cell square, bool passed) {
  if (passed && reached_[edge] <= kStands) return 0;
  const float when = passed ? reached(edge) : static_cast<float>(crossed(edge, square));
  complex_.for_each_face(square,
                         [&](Cell face) { reached_[face] = -std::max(std::abs(reached_[face]), when); });
  return when;
}

float SheetFronts::reached(Cell edge) {
  return std::max(std::abs(reached_[edge]), static_cast<float>(radius_about(complex_, depth_, edge)));
}

// When the front that stands at an edge of a square has crossed that.
double SheetFronts::crossed(Cell edge, Cell square) {
  const auto before = static_cast<double>(reached(edge));
  const std::uint32_t cube = DualComplex::cube_of(square), place = DualComplex::place_of(square);
  const auto side = [&](std::size_t axis, bool upper) {
    const std::uint32_t weight = DualComplex::kWeight[axis];
    return complex_.cell(cube, upper ? place + weight : place - weight);
  };
  std::size_t across = 0;
  while (DualComplex::digit(place, across) == 1) ++across;
  std::size_t along = (across + 1) % 3, beside = (across + 2) % 3;
  if (edge != side(along, false) && edge != side(along, true)) std::swap(along, beside);
  const Vec3 n = sheet_normal(square, across);
  double best = before + advance(n[along]);
  for (const bool upper : {false, true}) {
    const Cell other = side(beside, upper);
    if (reached_[other] <= 0) continue;
    const auto since = static_cast<double>(reached(other));
    const double sign = (edge == side(along, upper)) ? 1 : -1;
    best = std::min(best, front_time(before, since, n[along], sign * n[beside]));
  }
  return best;
}

// Across the sheet that a square is of: from one side of it to the other the depth's slope turns.  0 where it is
// of none.
Vec3 SheetFronts::sheet_normal(Cell square, std::size_t across) const {
  Vec3 n;
  for (const auto& [cube, place] : complex_.star(square)) {
    const std::uint32_t digit = DualComplex::digit(place, across);
    const double sign = digit == 0 ? 1 : -1;
    const std::uint32_t behind = complex_.neighbour(cube, across, 2 - digit);
    for (const std::uint32_t of : {cube, behind == kNone ? cube : behind}) n = n + sign * slope_at(of);
  }
  const double length = norm(n);
  return length > kSheet ? (1 / length) * n : Vec3{};
}

// Whether what is left of the cubes about a cell lies off the medial axis, where the front has passed already.  A step
// a spacing long, along one axis, would take it longer than the front took: lines of round limbs were born late then,
// at 1.4 to 1.8 times their radius.
bool SheetFronts::is_passed(Cell cell, Cell coface) const {
  const DualComplex::Star about = complex_.star(coface);
  Vec3 slope;
  for (const auto& member : about) slope = slope + slope_at(member.cube);
  slope = (1 / static_cast<double>(about.count)) * slope;
  if (norm(slope) <= kOffAxis) return false;
  if (DualComplex::dimension(coface) == 1) return true;
  const std::uint32_t cube = DualComplex::cube_of(coface), place = DualComplex::place_of(coface);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (DualComplex::digit(place, axis) != 1) continue;
    if (cell == complex_.cell(cube, place - DualComplex::kWeight[axis])) return slope[axis] > kOnwards;
    if (cell == complex_.cell(cube, place + DualComplex::kWeight[axis])) return -slope[axis] > kOnwards;
  }
  return false;
}

}  // namespace affskel::core
