#include "client/files/write/armature.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "core/base/groups.h"

namespace affskel::client {
namespace {

using core::Vec3;

constexpr double kTolerance = 0.25;  // of the part's radius
constexpr double kBlend = 0.25;      // of a bone's length, at either end

// Where on the way from a to b a place is nearest to it, 0 .. 1.
double share_along(const Vec3& place, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double square = core::dot(way, way);
  return square > 0 ? std::clamp(core::dot(place - a, way) / square, 0.0, 1.0) : 0;
}

double distance_to(const Vec3& place, const Vec3& a, const Vec3& b) {
  return core::norm(a + share_along(place, a, b) * (b - a) - place);
}

// The places of a line that is to be kept, its ends among them.
void keep_bends(std::span<const Vec3> line, std::size_t first, std::size_t last, double tolerance,
                std::vector<char>& kept) {
  double farthest = tolerance;
  std::size_t bend = first;
  for (std::size_t n = first + 1; n < last; ++n) {
    const double distance = distance_to(line[n], line[first], line[last]);
    if (distance <= farthest) continue;
    farthest = distance;
    bend = n;
  }
  if (bend == first) return;
  kept[bend] = 1;
  keep_bends(line, first, bend, tolerance, kept);
  keep_bends(line, bend, last, tolerance, kept);
}

class ArmatureBuilder {
 public:
  explicit ArmatureBuilder(const LimbedSurface& solid)
      : solid_(solid),
        done_(solid.branches.size(), 0),
        joint_at_(solid.places.size(), Joint::kNone),
        bones_(done_.size()),
        counts_(done_.size(), 0) {
    at_vertex_ = {solid.places.size(), [&](const auto& put) {
                    for (std::uint32_t part = 0; part < done_.size(); ++part) {
                      const auto& branch = solid.branches[part];
                      put(branch.front(), part);
                      if (branch.back() != branch.front()) put(branch.back(), part);
                    }
                  }};
  }

  Armature run() {
    for (std::uint32_t part = 0; part < done_.size(); ++part)
      if (!done_[part]) grow(solid_.branches[part].front(), part);
    bind();
    return std::move(armature_);
  }

 private:
  // A bone, and where it ends.
  struct Bone {
    std::uint32_t joint;
    Vec3 end;
  };

  std::uint32_t add(const Vec3& place, std::uint32_t parent, std::uint32_t part) {
    armature_.joints.push_back({place, parent, part, counts_[part]++});
    return static_cast<std::uint32_t>(armature_.joints.size() - 1);
  }

  // A piece of the curve, from a vertex on.
  void grow(std::uint32_t vertex, std::uint32_t first_part) {
    joint_at_[vertex] = add(solid_.places[vertex], Joint::kNone, first_part);
    std::vector<std::uint32_t> met{vertex};
    for (std::size_t n = 0; n < met.size(); ++n) {
      const std::uint32_t from = met[n];
      for (const std::uint32_t part : at_vertex_[from]) {
        if (done_[part]) continue;
        done_[part] = 1;
        std::vector<std::uint32_t> branch = solid_.branches[part];
        if (branch.front() != from) std::reverse(branch.begin(), branch.end());
        const std::uint32_t last = grow_branch(part, branch), to = branch.back();
        if (joint_at_[to] != Joint::kNone) continue;
        joint_at_[to] = last;
        met.push_back(to);
      }
    }
  }

  // From its first vertex.  @returns the joint of its last bone, or at its tip.
  std::uint32_t grow_branch(std::uint32_t part, const std::vector<std::uint32_t>& branch) {
    std::uint32_t last = joint_at_[branch.front()];
    if (branch.size() < 2) return last;
    std::vector<Vec3> line;
    for (const std::uint32_t v : branch) line.push_back(solid_.places[v]);
    std::vector<char> kept(line.size(), 0);
    const double tolerance = kTolerance * solid_.radius[part];
    const std::size_t end = line.size() - 1;
    const std::size_t bend = branch.front() == branch.back() ? end / 2 : end;  // a loop bends somewhere
    kept[bend] = kept[end] = 1;
    keep_bends(line, 0, bend, tolerance, kept);
    keep_bends(line, bend, end, tolerance, kept);
    std::size_t before = 0;
    for (std::size_t n = 1; n < line.size(); ++n) {
      if (!kept[n]) continue;
      last = add(line[before], last, part);
      bones_[part].push_back({last, line[n]});
      before = n;
    }
    // Where nothing goes on there is a joint at the tip: else the last bone would have no end.
    const std::uint32_t to = branch.back();
    const bool tip = joint_at_[to] == Joint::kNone && at_vertex_[to].size() == 1;
    return tip ? add(line.back(), last, part) : last;
  }

  void bind() {
    const auto& mesh = solid_.surface;
    const core::Groups<std::uint32_t> triangles(mesh.points.size(), [&](const auto& put) {
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) put(v, t);
    });
    for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
      std::vector<std::uint32_t> parts;
      for (const std::uint32_t t : triangles[v]) parts.push_back(solid_.triangle_part[t]);
      if (parts.empty()) parts.push_back(0);  // of a vertex that no triangle uses
      std::sort(parts.begin(), parts.end());
      parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
      armature_.bindings.push_back(binding_of(mesh.points[v], parts));
    }
  }

  Binding binding_of(const Vec3& place, const std::vector<std::uint32_t>& parts) const {
    double least = std::numeric_limits<double>::infinity();
    const std::uint32_t root = joint_at_[solid_.branches[parts.front()].front()];
    Binding binding{{root, root}, 1};
    for (const std::uint32_t part : parts) {
      const auto& bones = bones_[part];
      for (std::size_t b = 0; b < bones.size(); ++b) {
        const Vec3& begin = armature_.joints[bones[b].joint].place;
        const double distance = distance_to(place, begin, bones[b].end);
        if (distance >= least) continue;
        least = distance;
        binding = blended(bones, b, share_along(place, begin, bones[b].end));
      }
    }
    return binding;
  }

  // The bone, and at its ends the ones before and after it on the same branch, half each where they meet.
  static Binding blended(const std::vector<Bone>& bones, std::size_t b, double along) {
    const std::uint32_t own = bones[b].joint;
    if (along < kBlend && b > 0) return {{own, bones[b - 1].joint}, 0.5 + 0.5 * along / kBlend};
    if (along > 1 - kBlend && b + 1 < bones.size())
      return {{own, bones[b + 1].joint}, 0.5 + 0.5 * (1 - along) / kBlend};
    return {{own, own}, 1};
  }

  const LimbedSurface& solid_;
  std::vector<char> done_;               // per part
  std::vector<std::uint32_t> joint_at_;  // per vertex of the curve: where branches begin, that they hang on
  core::Groups<std::uint32_t> at_vertex_;
  std::vector<std::vector<Bone>> bones_;  // per part, from where it was begun
  std::vector<std::uint32_t> counts_;     // of joints, per part
  Armature armature_;
};

}  // namespace

Armature make_armature(const LimbedSurface& solid) {
  return ArmatureBuilder(solid).run();
}

}  // namespace affskel::client
