#include "core/mesh/patch_senses.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/groups.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

struct Neighbour {
  std::uint32_t triangle = 0;
  bool agrees = false;  // as the triangles came: it runs along the edge the other way
};

bool runs_up(const Triangle& t, const EdgeSide& side) {
  return t[(side.half_edge + 1) % 3] == side.high;
}

Groups<Neighbour> neighbours_across(std::size_t points, std::span<const Triangle> triangles) {
  const Edges edges(points, triangles);
  return {triangles.size(), [&](const auto& put) {
            edges.for_each([&](std::uint32_t, std::uint32_t, std::span<const EdgeSide> sides) {
              if (sides.size() != 2) return;
              const std::uint32_t a = sides[0].triangle(), b = sides[1].triangle();
              const bool agrees = runs_up(triangles[a], sides[0]) != runs_up(triangles[b], sides[1]);
              put(a, Neighbour{b, agrees});
              put(b, Neighbour{a, agrees});
            });
          }};
}

}  // namespace

void agree_on_senses(std::size_t points, std::span<Triangle> triangles) {
  enum class Sense : char { kUnknown, kKept, kTurned };
  const Groups<Neighbour> across = neighbours_across(points, triangles);
  std::vector<Sense> sense(triangles.size(), Sense::kUnknown);
  std::vector<std::uint32_t> next;
  for (std::uint32_t first = 0; first < triangles.size(); ++first) {
    if (sense[first] != Sense::kUnknown) continue;
    sense[first] = Sense::kKept;
    next.assign(1, first);
    while (!next.empty()) {
      const std::uint32_t t = next.back();
      next.pop_back();
      for (const Neighbour& to : across[t]) {
        if (sense[to.triangle] != Sense::kUnknown) continue;
        const bool kept = (sense[t] == Sense::kKept) == to.agrees;
        sense[to.triangle] = kept ? Sense::kKept : Sense::kTurned;
        next.push_back(to.triangle);
      }
    }
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    if (sense[t] == Sense::kTurned) std::swap(triangles[t][1], triangles[t][2]);
}

}  // namespace affskel::core
