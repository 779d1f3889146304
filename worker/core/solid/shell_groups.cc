#include "core/solid/shell_groups.h"

#include <algorithm>

#include "core/base/disjoint_sets.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

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

}  // namespace

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

}  // namespace affskel::core
