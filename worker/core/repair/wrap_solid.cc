#include "core/repair/wrap_solid.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/none.h"
#include "core/base/unit.h"
#include "core/solid/shell_nesting.h"
#include "core/solid/solid.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {
namespace {

std::optional<Solid> solid_if_any(const Mesh& mesh, ExecutionContext* context) {
  try {
    return make_solid(mesh, {.context = context});
  } catch (const CoreError& error) {
    if (error.code() != CoreError::Code::kBadInput) throw;
    return std::nullopt;
  }
}

void append(Mesh& mesh, const Mesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), more.points.begin(), more.points.end());
  for (const Triangle& t : more.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

struct Room {
  Vec3 middle;
  double radius = 0;
};

// The largest of the balls that touch a cavity's wall in the middle of a triangle, looked at evenly, and hold nothing
// of the surface: each shrinks until it does not (Ma, Bae and Choi 2012).
// @param surface the wall, facing into the cavity, before what lies in it.
Room room_in(const Mesh& surface, std::size_t wall_triangles, ExecutionContext* context) {
  constexpr std::size_t kLookedAt = 500;
  constexpr int kMostSteps = 60;
  const DistanceToMesh distance(surface);
  const double most = box_of(surface).diagonal();
  const std::size_t step = 1 + wall_triangles / kLookedAt;
  Room largest;
  for (std::size_t t = 0; t < wall_triangles; t += step) {
    throw_if_stopped(context);
    const auto [a, b, c] = surface.triangles[t];
    const Vec3 foot = (1.0 / 3) * (surface.points[a] + surface.points[b] + surface.points[c]);
    const Vec3 normal = unit(twice_area(surface, surface.triangles[t]));
    double radius = most;
    for (int i = 0; i < kMostSteps && radius > largest.radius; ++i) {
      const Vec3 middle = foot + radius * normal, met = distance.nearest_place(middle), way = met - foot;
      if (norm(met - middle) > 0.999 * radius) {
        largest = {middle, norm(met - middle)};
        break;
      }
      const double along = 2 * dot(normal, way);
      radius = along > 0 ? dot(way, way) / along : 0;
    }
  }
  return largest;
}

class CavityWrapper {
 public:
  CavityWrapper(const Solid& solid, const AlphaWrapOptions& options)
      : solid_(solid),
        options_(options),
        count_(solid.shells.size()),
        nesting_(nest_shells(solid.mesh, solid.triangle_shell, static_cast<std::uint32_t>(count_),
                             {.context = options.context})),
        triangles_(count_),
        within_(count_),
        crosses_(count_, false),
        is_kept_(count_, false) {
    for (std::uint32_t t = 0; t < solid.triangle_shell.size(); ++t)
      triangles_[solid.triangle_shell[t]].push_back(t);
    for (std::uint32_t s = 0; s < count_; ++s)
      if (nesting_.parent[s] != kNone) within_[nesting_.parent[s]].push_back(s);
    for (const auto& [i, j] : solid.crossings) {
      const std::uint32_t a = solid.triangle_shell[i], b = solid.triangle_shell[j];
      if (a != b) crosses_[a] = crosses_[b] = true;
    }
  }

  void add_to(SolidWrap& wrap) {
    // What touches may lie on another, and count twice, too.
    wrap.volume = solid_.volume;
    wrap.overlaps = solid_.self_intersecting;
    std::vector<std::uint32_t> outermost_first(count_);
    std::iota(outermost_first.begin(), outermost_first.end(), 0U);
    std::stable_sort(outermost_first.begin(), outermost_first.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return nesting_.depth[a] < nesting_.depth[b]; });
    for (const std::uint32_t s : outermost_first) {
      // Of a surface that is round it, but not round what that is in, the two cross.
      const std::uint32_t parent = nesting_.parent[s];
      const bool has_place =
          parent == kNone || (is_kept_[parent] && nesting_.depth[parent] + 1 == nesting_.depth[s]);
      is_kept_[s] = has_place && (!solid_.shells[s].cavity || keep(s, wrap.mesh));
      if (solid_.shells[s].cavity) (is_kept_[s] ? wrap.kept : wrap.closed) += 1;
    }
  }

 private:
  void append_shell(std::uint32_t shell, Mesh& mesh) const {
    for (const std::uint32_t t : triangles_[shell]) {
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      for (const std::uint32_t v : solid_.mesh.triangles[t])
        mesh.points.push_back(solid_.centre + solid_.scale() * solid_.mesh.points[v]);
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }

  bool keep(std::uint32_t cavity, Mesh& wrap) const {
    if (crosses_[cavity]) return false;
    Mesh surfaces;  // its wall, and what lies right in it
    append_shell(cavity, surfaces);
    for (const std::uint32_t s : within_[cavity]) append_shell(s, surfaces);
    const Room room = room_in(surfaces, triangles_[cavity].size(), options_.context);
    if (room.radius < options_.alpha) return false;
    AlphaWrapOptions within = options_;
    within.from = room.middle;
    const Mesh wall = alpha_wrap(surfaces, within);
    append(wrap, wall);
    return !wall.triangles.empty();
  }

  const Solid& solid_;
  const AlphaWrapOptions& options_;
  const std::size_t count_;  // of shells
  const ShellNesting nesting_;
  std::vector<std::vector<std::uint32_t>> triangles_, within_;  // per shell; within_: the shells right in it
  std::vector<bool> crosses_;                                   // per shell: another one
  std::vector<bool> is_kept_;  // per shell: what it bounds has a part in the wrap
};

}  // namespace

SolidWrap wrap_solid(const Mesh& mesh, const AlphaWrapOptions& options) {
  SolidWrap wrap;
  wrap.mesh = alpha_wrap(mesh, options);
  const std::optional<Solid> solid =
      mesh.triangles.empty() ? std::nullopt : solid_if_any(mesh, options.context);
  if (solid) CavityWrapper(*solid, options).add_to(wrap);
  take_back_offset(wrap.mesh, options);
  return wrap;
}

}  // namespace affskel::core
