#include "core/curve/thick_joints.h"

#include <algorithm>
#include <cstddef>

#include "core/base/disjoint_sets.h"

namespace affskel::core {
namespace {

// Times as thick: where tubes alone meet the balls are up to 1.22 of the widest.
constexpr double kThick = 1.3;

}  // namespace

std::vector<std::uint32_t> thick_joints(std::span<const Vec3> places,
                                        std::span<const std::vector<std::uint32_t>> lines,
                                        std::span<const double> size, std::span<JointBalls> joints) {
  std::vector<std::uint32_t> ends(places.size(), 0);  // of lines
  for (const auto& line : lines)
    for (const std::uint32_t v : {line.front(), line.back()}) ++ends[v];
  const auto is_joint = [&](std::uint32_t v) { return ends[v] > 2; };
  DisjointSets bodies(places.size());
  std::vector<char> is_inner(lines.size(), 0);
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const std::uint32_t a = lines[n].front(), b = lines[n].back();
    if (!is_joint(a) || !is_joint(b)) continue;
    if (std::max(joints[a].size, joints[b].size) > kThick * size[n]) continue;
    is_inner[n] = std::all_of(lines[n].begin(), lines[n].end(), [&](std::uint32_t v) {
      return joints[a].hold(places[v], 1) || joints[b].hold(places[v], 1);
    });
    if (is_inner[n]) bodies.unite(a, b);
  }
  std::vector<std::uint32_t> core(places.size(),
                                  kNoThickJoint);  // per body's first vertex: its largest joint
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    if (!is_joint(v)) continue;
    std::uint32_t& largest = core[bodies.find(v)];
    if (largest == kNoThickJoint || joints[v].size > joints[largest].size) largest = v;
  }
  std::vector<std::uint32_t> result(places.size(), kNoThickJoint);
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    const std::uint32_t largest = is_joint(v) ? core[bodies.find(v)] : v;
    if (largest != v || !is_joint(v)) continue;
    const auto is_met = [&](std::uint32_t end) {
      return is_joint(end) &&
             (bodies.find(end) == bodies.find(v) || joints[v].hold(places[end], JointBalls::kNear));
    };
    double most = 0;
    for (std::size_t n = 0; n < lines.size(); ++n)
      if (!is_inner[n] && (is_met(lines[n].front()) || is_met(lines[n].back())))
        most = std::max(most, size[n]);
    if (joints[v].size > kThick * most) result[v] = v;
  }
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    if (!is_joint(v) || core[bodies.find(v)] == v) continue;
    result[v] = result[core[bodies.find(v)]];
    if (result[v] != kNoThickJoint) joints[result[v]].add(joints[v]);
  }
  return result;
}

}  // namespace affskel::core
