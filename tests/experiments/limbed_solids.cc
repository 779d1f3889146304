#include "limbed_solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/shapes/edge_collapse.h"
#include "core/shapes/implicit_mesh.h"

namespace affskel::experiments {
namespace {

using core::ImplicitFunction;
using core::Vec3;

constexpr double kEdge = 0.05;  // of the meshes before they are made coarser

struct Bone {
  Vec3 from, to;
  double radius = 0;
};

double distance_to(const Vec3& p, const Bone& bone) {
  const Vec3 along = bone.to - bone.from;
  const double t = std::clamp(dot(p - bone.from, along) / dot(along, along), 0.0, 1.0);
  return norm(p - bone.from - t * along) - bone.radius;
}

ImplicitFunction bones(std::vector<Bone> list) {
  return [list = std::move(list)](const Vec3& p) {
    double least = HUGE_VAL;
    for (const Bone& bone : list) least = std::min(least, distance_to(p, bone));
    return least;
  };
}

// A ring about the axis z through a centre, or y.
double ring(const Vec3& p, double major, double minor, bool about_y = false) {
  const double across = about_y ? p.y : p.z, other = about_y ? p.z : p.y;
  return std::hypot(std::hypot(p.x, other) - major, across) - minor;
}

double block(const Vec3& p, const Vec3& half) {
  const Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
  const Vec3 outside{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return norm(outside) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

ImplicitFunction hand() {
  const ImplicitFunction fingers = bones({{{-0.36, 0.3, 0}, {-0.46, 0.85, 0}, 0.085},
                                          {{-0.12, 0.35, 0}, {-0.14, 1, 0}, 0.09},
                                          {{0.12, 0.35, 0}, {0.15, 0.97, 0}, 0.09},
                                          {{0.34, 0.3, 0}, {0.44, 0.78, 0}, 0.075},
                                          {{-0.35, -0.15, 0}, {-0.85, 0.2, 0.05}, 0.1},
                                          {{0, -0.3, 0}, {0, -0.9, 0}, 0.2}});
  return [fingers](const Vec3& p) { return std::min(fingers(p), block(p, {0.34, 0.34, 0.06}) - 0.08); };
}

ImplicitFunction animal() {
  return bones({{{-0.6, 0, 0}, {0.5, 0, 0}, 0.3},
                {{-0.6, 0.18, 0}, {-0.65, 0.25, -0.9}, 0.1},
                {{-0.6, -0.18, 0}, {-0.65, -0.25, -0.9}, 0.1},
                {{0.5, 0.18, 0}, {0.5, 0.25, -0.9}, 0.1},
                {{0.5, -0.18, 0}, {0.5, -0.25, -0.9}, 0.1},
                {{0.6, 0, 0.1}, {0.95, 0, 0.55}, 0.14},
                {{0.95, 0, 0.55}, {1.15, 0, 0.5}, 0.17},
                {{0.9, 0.1, 0.6}, {0.85, 0.25, 0.85}, 0.05},
                {{0.9, -0.1, 0.6}, {0.85, -0.25, 0.85}, 0.05},
                {{-0.85, 0, 0.1}, {-1.4, 0, -0.3}, 0.06}});
}

ImplicitFunction tree() {
  return bones({{{0, 0, -1}, {0, 0, 0}, 0.15},
                {{0, 0, 0}, {0.5, 0, 0.5}, 0.11},
                {{0, 0, 0}, {-0.5, 0, 0.5}, 0.11},
                {{0.5, 0, 0.5}, {0.6, 0.4, 1}, 0.08},
                {{0.5, 0, 0.5}, {0.9, -0.3, 0.9}, 0.08},
                {{-0.5, 0, 0.5}, {-0.6, -0.4, 1}, 0.08},
                {{-0.5, 0, 0.5}, {-0.9, 0.3, 0.9}, 0.08}});
}

ImplicitFunction comb() {
  std::vector<Bone> list{{{-1, 0, 0}, {1, 0, 0}, 0.15}};
  for (const double x : {-1.0, -0.5, 0.0, 0.5, 1.0}) list.push_back({{x, 0, 0}, {x, 0, -0.9}, 0.1});
  return bones(std::move(list));
}

ImplicitFunction trefoil() {
  constexpr int kParts = 48;
  std::vector<Bone> list;
  const auto at = [](int n) {
    const double t = 2 * std::numbers::pi * n / kParts;
    return Vec3{0.35 * (std::sin(t) + 2 * std::sin(2 * t)), 0.35 * (std::cos(t) - 2 * std::cos(2 * t)),
                -0.35 * std::sin(3 * t)};
  };
  for (int n = 0; n < kParts; ++n) list.push_back({at(n), at(n + 1), 0.15});
  return bones(std::move(list));
}

ImplicitFunction amphora() {
  return [](const Vec3& p) {
    const double belly = distance_to(p, {{0, 0, -0.5}, {0, 0, 0.1}, 0.45});
    const double neck = distance_to(p, {{0, 0, 0}, {0, 0, 1}, 0.18});
    double handles = HUGE_VAL;
    for (const double side : {-1.0, 1.0})
      handles = std::min(handles, ring(p - Vec3{side * 0.28, 0, 0.6}, 0.25, 0.07, true));
    return std::min({belly, neck, handles});
  };
}

// Edges are rounded, so that the mesh has them as they are.
ImplicitFunction pierced_block() {
  return [](const Vec3& p) {
    constexpr double kRound = 0.08;
    double holes = HUGE_VAL;
    for (const double x : {-0.65, 0.0, 0.65}) holes = std::min(holes, std::hypot(p.x - x, p.y) - 0.18);
    const double a = block(p, {0.92, 0.32, 0.12}) - 0.08, b = -holes;
    return std::min(-kRound, std::max(a, b)) +
           std::hypot(std::max(a + kRound, 0.0), std::max(b + kRound, 0.0));
  };
}

}  // namespace

std::vector<NamedMesh> limbed_solids(std::size_t triangles) {
  const std::vector<std::pair<std::string, ImplicitFunction>> functions{
      {"hand", hand()},
      {"animal", animal()},
      {"tree", tree()},
      {"comb", comb()},
      {"trefoil knot", trefoil()},
      {"amphora", amphora()},
      {"block with holes", pierced_block()},
      {"hollow ball", [](const Vec3& p) { return std::abs(norm(p) - 0.8) - 0.2; }},
      {"torus", [](const Vec3& p) { return ring(p, 0.8, 0.3); }}};
  std::vector<NamedMesh> solids;
  for (const auto& [name, function] : functions) {
    core::Mesh mesh = core::mesh_zero_set(function, {{-1.7, -1.7, -1.7}, {1.7, 1.7, 1.7}, kEdge});
    core::fair_onto(function, 0.01 * kEdge, 3, mesh);
    for (Vec3& p : mesh.points) p.x += 2;  // the collapse keeps to x >= 0
    solids.push_back({name, core::collapse_edges(mesh, triangles)});
  }
  return solids;
}

}  // namespace affskel::experiments
