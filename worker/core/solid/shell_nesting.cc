// Surfaces that touch or cross are a group.  Two groups have no point in common, so a group lies with all its
// points on one side of every surface of another group.
//
// Groups are taken from the highest to the lowest.  From the highest vertex p of group K a ray goes up.
// Nothing lies between p and the first triangle it meets, of a group L, which reaches higher than p, so that
// its nesting is known.  Hence round K are all surfaces round the whole of L, and those of L itself that p is
// inside of.  These are told by the parity of their crossings, on the ray's stretch up to the top of L.
//
// Within a group nothing follows from anything else: the rays go up from all six extreme vertices of each
// surface and count what they cross of the group.  What holds a surface reaches higher, so its depth is
// known.
#include "core/solid/shell_nesting.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/disjoint_sets.h"
#include "core/spatial/box_tree.h"
#include "core/spatial/ray_crossing.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

constexpr int kUp = 2;

using Extremes = std::array<std::uint32_t, 6>;  // vertices with the least and greatest x, y, z

// The closed surfaces that matter for how they lie in one another.
struct NestingShells {
  std::vector<Box> box;                  // per surface
  std::vector<std::uint8_t> matters;     // per surface: its box lies in another's, or holds another's
  std::vector<std::uint32_t> triangles;  // of the surfaces that matter, ascending
};

// Whether `inner` lies in `outer`, no side of one touching the other's.
bool lies_strictly_in(const Box& inner, const Box& outer) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(outer.low[k] < inner.low[k] && inner.high[k] < outer.high[k])) return false;
  }
  return true;
}

// Looks at the boxes that `may` be of interest until one is found, and counts them.
template <class May>
struct Quest {
  explicit Quest(May asked, bool known = false) : may(asked), found(known) {}

  bool meets(const Box& box) const {
    ++looks;
    return !found && may(box);
  }

  May may;
  bool found;
  mutable std::uint64_t looks = 0;
};

// O(N + S log S) for S surfaces unless boxes lie on one another in heaps.
NestingShells nesting_shells(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                             std::uint32_t shells, ExecutionContext* context) {
  NestingShells result{std::vector<Box>(shells), std::vector<std::uint8_t>(shells, 0), {}};
  for (std::uint32_t t = 0; t < triangle_shell.size(); ++t)
    result.box[triangle_shell[t]].include(box_of(mesh, mesh.triangles[t]));
  const BoxTree tree(result.box);
  StopCheck stop(context);
  for (std::uint32_t s = 0; s < shells; ++s) {
    const Box& own = result.box[s];
    // A node of the tree holds the box strictly when one of its boxes does.
    Quest round([&](const Box& outer) { return lies_strictly_in(own, outer); });
    tree.visit(round, [&](std::uint32_t) { round.found = true; });
    Quest within([&](const Box& other) { return own.meets(other); }, round.found);
    tree.visit(within, [&](std::uint32_t other) { within.found = lies_strictly_in(result.box[other], own); });
    stop.did(round.looks + within.looks);
    result.matters[s] = round.found || within.found ? 1 : 0;
  }
  for (std::uint32_t t = 0; t < triangle_shell.size(); ++t) {
    if (result.matters[triangle_shell[t]] != 0) result.triangles.push_back(t);
  }
  return result;
}

// Groups surfaces that touch or cross each other, and those joined by others that do; exact.  Looks at the triangles of all
// surfaces but the largest: O(N log N) and the pairs of boxes of triangles that meet.
// @param tree over the boxes of `shells.triangles`, by their position in the list.
// @return per surface the least index in its group.
std::vector<std::uint32_t> shell_groups(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                                        const NestingShells& shells, const BoxTree& tree,
                                        ExecutionContext* context) {
  const std::size_t count = shells.box.size();
  std::vector<std::uint32_t> size(count, 0);
  for (const std::uint32_t t : shells.triangles) ++size[triangle_shell[t]];
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  auto groups = static_cast<std::size_t>(std::count(shells.matters.begin(), shells.matters.end(), 1));
  DisjointSets sets(count);
  StopCheck stop(context);
  for (std::size_t at = 0; at < shells.triangles.size() && groups > 1; ++at) {
    const std::uint32_t t = shells.triangles[at], shell = triangle_shell[t];
    if (shell == largest) continue;
    tree.visit(tree.box(static_cast<std::uint32_t>(at)), [&](std::uint32_t other_at) {
      stop.did(4);
      const std::uint32_t other = shells.triangles[other_at];
      if (sets.find(shell) == sets.find(triangle_shell[other])) return;
      stop.did(64);
      if (triangles_meet(mesh, t, other) && sets.unite(shell, triangle_shell[other])) --groups;
    });
    stop.did(64);
  }
  std::vector<std::uint32_t> group(count);
  for (std::uint32_t s = 0; s < count; ++s) group[s] = sets.find(s);
  return group;
}

class Nester {
 public:
  Nester(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell, std::uint32_t shells,
         const ShellNestingOptions& options)
      : mesh_(mesh),
        triangle_shell_(triangle_shell),
        options_(options),
        stop_(options.context),
        shells_(nesting_shells(mesh, triangle_shell, shells, options.context)),
        nesting_{std::vector<std::uint32_t>(shells, 0), std::vector<std::uint32_t>(shells, kNone)} {}

  ShellNesting run() {
    if (shells_.triangles.empty()) return std::move(nesting_);
    throw_if_stopped(options_.context);
    plant_tree();
    throw_if_stopped(options_.context);
    group_ = shell_groups(mesh_, triangle_shell_, shells_, tree_, options_.context);
    find_extremes();
    find_groups();
    odd_.assign(group_.size(), 0);
    for (const std::uint32_t s : highest_first()) {
      Group& group = groups_[group_[s]];
      if (!group.placed) place(s, group);
      nesting_.depth[s] = group.depth;
      nesting_.parent[s] = group.parent;
      if (group.members > 1) nest_within(s);
    }
    return std::move(nesting_);
  }

 private:
  struct Group {
    std::uint32_t members = 0;
    double top = -std::numeric_limits<double>::infinity();
    bool placed = false;
    std::uint32_t depth = 0, parent = kNone;  // of what lies round all of it
  };

  void plant_tree() {
    std::vector<Box> boxes;
    boxes.reserve(shells_.triangles.size());
    for (const std::uint32_t t : shells_.triangles) boxes.push_back(box_of(mesh_, mesh_.triangles[t]));
    tree_ = BoxTree(std::move(boxes), options_.threads);
  }

  void find_extremes() {
    Extremes none;
    none.fill(kNone);
    extremes_.assign(group_.size(), none);
    for (const std::uint32_t t : shells_.triangles) {
      Extremes& extremes = extremes_[triangle_shell_[t]];
      for (const std::uint32_t v : mesh_.triangles[t]) extend(extremes, v);
    }
  }

  void extend(Extremes& extremes, std::uint32_t v) const {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t &least = extremes[2 * k], &most = extremes[2 * k + 1];
      if (least == kNone || mesh_.points[v][k] < mesh_.points[least][k]) least = v;
      if (most == kNone || mesh_.points[v][k] > mesh_.points[most][k]) most = v;
    }
  }

  void find_groups() {
    groups_.resize(group_.size());
    for (std::uint32_t s = 0; s < group_.size(); ++s) {
      Group& group = groups_[group_[s]];
      ++group.members;
      group.top = std::max(group.top, top(s));
    }
  }

  double top(std::uint32_t shell) const { return shells_.box[shell].high[kUp]; }
  const Vec3& highest_vertex(std::uint32_t shell) const { return mesh_.points[extremes_[shell].back()]; }

  // The surfaces that matter.
  std::vector<std::uint32_t> highest_first() const {
    std::vector<std::uint32_t> order;
    for (std::uint32_t s = 0; s < group_.size(); ++s) {
      if (shells_.matters[s] != 0) order.push_back(s);
    }
    std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
      return top(a) != top(b) ? top(a) > top(b) : a < b;
    });
    return order;
  }

  // What lies round a group, from its highest surface.
  void place(std::uint32_t highest, Group& group) {
    group.placed = true;
    const Vec3& p = highest_vertex(highest);
    const std::uint32_t met = first_met(p);
    if (met == kNone) return;
    const Group& other = groups_[group_[met]];
    group.depth = other.depth;
    group.parent = other.parent;
    for (const std::uint32_t s : crossed_oddly(p, group_[met])) take_round(s, group.depth, group.parent);
  }

  // One more surface lies round.
  void take_round(std::uint32_t outer, std::uint32_t& depth, std::uint32_t& parent) const {
    ++depth;
    const auto deeper = [this](std::uint32_t a, std::uint32_t b) {
      return nesting_.depth[a] != nesting_.depth[b] ? nesting_.depth[a] > nesting_.depth[b] : a < b;
    };
    if (parent == kNone || deeper(outer, parent)) parent = outer;
  }

  // The surface of the first triangle above p, of a group placed already; kNone when there is none.
  std::uint32_t first_met(const Vec3& p) {
    WayQuery ray = upward(p, std::numeric_limits<double>::infinity());
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t first = kNone;
    cross(ray, [&](std::uint32_t t, double distance) {
      if (distance > nearest || (distance == nearest && t > first)) return;
      const Group& group = groups_[group_[triangle_shell_[t]]];
      // What begins at this height meets the ray by rounding only.
      if (!group.placed || !(group.top > p.z)) return;
      nearest = distance;
      first = t;
      ray.last = distance;
    });
    return first == kNone ? kNone : triangle_shell_[first];
  }

  // The surfaces of a group that p is inside of, ascending.
  std::vector<std::uint32_t> crossed_oddly(const Vec3& p, std::uint32_t group) {
    std::vector<std::uint32_t> crossed;
    cross(upward(p, groups_[group].top - p.z), [&](std::uint32_t t, double) {
      const std::uint32_t shell = triangle_shell_[t];
      if (group_[shell] != group) return;
      if (odd_[shell] == 0) crossed.push_back(shell);
      odd_[shell] = odd_[shell] == 1 ? 2 : 1;
    });
    std::vector<std::uint32_t> odd;
    for (const std::uint32_t shell : crossed) {
      if (odd_[shell] == 1) odd.push_back(shell);
      odd_[shell] = 0;
    }
    std::sort(odd.begin(), odd.end());
    return odd;
  }

  // The surfaces of its own group round one of several.
  void nest_within(std::uint32_t inner) {
    std::vector<std::uint32_t> round;
    for (std::size_t k = 0; k < extremes_[inner].size(); ++k) {
      const std::uint32_t v = extremes_[inner][k];
      std::vector<std::uint32_t> odd = crossed_oddly(mesh_.points[v], group_[inner]);
      if (k == 0) {
        std::erase_if(odd,
                      [&](std::uint32_t s) { return !lies_strictly_in(shells_.box[inner], shells_.box[s]); });
        round = std::move(odd);
      } else {
        std::erase_if(round, [&](std::uint32_t s) { return !std::binary_search(odd.begin(), odd.end(), s); });
      }
      if (round.empty()) return;
    }
    nesting_.parent[inner] = kNone;
    for (const std::uint32_t s : round) take_round(s, nesting_.depth[inner], nesting_.parent[inner]);
  }

  static WayQuery upward(const Vec3& p, double length) { return {p, {0, 0, 1}, 0, length}; }

  // Calls visit(triangle, distance) for what the ray crosses; what lies at its start is not crossed.
  template <class Visit>
  void cross(const WayQuery& ray, Visit visit) {
    tree_.visit(ray, [&](std::uint32_t at) {
      ++nesting_.tests;
      stop_.did(kOperationsPerTest);
      const std::uint32_t t = shells_.triangles[at];
      const Triangle& corners = mesh_.triangles[t];
      if (winding_round_line(mesh_, corners, ray.from, kUp) == 0) return;
      const double distance = distance_along(mesh_, corners, ray.from, kUp);
      if (distance > 0) visit(t, distance);
    });
    stop_.did(kOperationsPerTest);
  }

  static constexpr std::uint64_t kOperationsPerTest = 16;

  const Mesh& mesh_;
  const std::vector<std::uint32_t>& triangle_shell_;
  const ShellNestingOptions options_;
  StopCheck stop_;
  const NestingShells shells_;
  BoxTree tree_;                      // over shells_.triangles
  std::vector<std::uint32_t> group_;  // per surface, see shell_groups
  std::vector<Extremes> extremes_;    // per surface
  std::vector<Group> groups_;         // by the least surface in it
  std::vector<std::uint8_t> odd_;     // per surface, while a ray is followed: 1 odd, 2 even, 0 not crossed
  ShellNesting nesting_;
};

}  // namespace

ShellNesting nest_shells(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                         std::uint32_t shells, const ShellNestingOptions& options) {
  if (shells == 1) return {{0}, {kNone}};
  return Nester(mesh, triangle_shell, shells, options).run();
}

}  // namespace affskel::core
