#include "core/solid/shells.h"

#include <bit>
#include <map>

#include "core/base/double_sum.h"
#include "core/base/split_mix64.h"
#include "core/solid/shell_nesting.h"

namespace affskel::core {
namespace {

void measure_shells(const HalfEdges& mates, Solid& solid) {
  std::uint32_t count = 0;
  solid.triangle_shell = connected_surfaces(mates, count);
  solid.shells.resize(count);
  const Mesh& mesh = solid.mesh;
  std::vector<DoubleSum> volume(count);
  std::vector<std::uint32_t> vertex_shell(mesh.points.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const std::uint32_t shell = solid.triangle_shell[t];
    volume[shell].add(dot(mesh.points[c[0]], cross(mesh.points[c[1]], mesh.points[c[2]])) / 6);
    ++solid.shells[shell].triangles;
    for (std::uint32_t v : c) vertex_shell[v] = shell;
  }
  for (std::uint32_t shell : vertex_shell) ++solid.shells[shell].vertices;
  for (std::uint32_t s = 0; s < count; ++s) {
    Shell& shell = solid.shells[s];
    shell.volume = volume[s].value();
    // Euler: V - E + F = 2 - 2 g with E = 3 F / 2.
    shell.genus =
        1 - (static_cast<std::int64_t>(shell.vertices) - static_cast<std::int64_t>(shell.triangles / 2)) / 2;
  }
}

// Shells at odd depth are cavities of the solid around them.
void nest(const SolidOptions& options, Solid& solid) {
  const auto count = static_cast<std::uint32_t>(solid.shells.size());
  const ShellNesting nesting =
      nest_shells(solid.mesh, solid.triangle_shell, count, {options.threads, options.context});
  std::uint32_t solids = 0;
  for (std::uint32_t s = 0; s < count; ++s) {
    solid.shells[s].cavity = nesting.depth[s] % 2 == 1;
    if (!solid.shells[s].cavity) solid.shells[s].solid = solids++;
  }
  solid.solid_volume.assign(solids, 0);
  for (std::uint32_t s = 0; s < count; ++s) {
    Shell& shell = solid.shells[s];
    if (shell.cavity) shell.solid = solid.shells[nesting.parent[s]].solid;
  }
}

// Of a place; 0 and -0 are the same.
std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (const double x : {p.x, p.y, p.z})
    hash = SplitMix64(hash ^ std::bit_cast<std::uint64_t>(x + 0.0)).next();
  return hash;
}

}  // namespace

void find_shells(const HalfEdges& mates, const SolidOptions& options, Solid& solid) {
  measure_shells(mates, solid);
  throw_if_stopped(options.context);
  nest(options, solid);
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> copied_shells(const Solid& solid) {
  // The sum of what a shell's corners hash to, whatever their order.
  std::vector<std::uint64_t> sums(solid.shells.size(), 0);
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t)
    for (const std::uint32_t v : solid.mesh.triangles[t])
      sums[solid.triangle_shell[t]] += hash_of(solid.mesh.points[v]);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> copies;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> first;
  for (std::uint32_t s = 0; s < solid.shells.size(); ++s) {
    const auto [known, is_new] = first.try_emplace({solid.shells[s].triangles, sums[s]}, s);
    if (!is_new) copies.emplace_back(known->second, s);
  }
  return copies;
}

}  // namespace affskel::core
