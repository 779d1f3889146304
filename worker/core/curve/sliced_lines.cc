#include "core/curve/sliced_lines.h"

#include "core/base/parallel.h"
#include "core/curve/limb_radii.h"
#include "core/lattice/lattice_points.h"
#include "core/mesh/edges.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Along the line, as far as that comes nearer.
std::uint32_t moved(std::span<const Vec3> places, const Adjacency& beside, const Vec3& at,
                    std::uint32_t nearest) {
  double least = norm(places[nearest] - at);
  for (bool moves = true; moves;) {
    moves = false;
    for (const std::uint32_t to : beside[nearest]) {
      const double way = norm(places[to] - at);
      if (way >= least) continue;
      least = way;
      nearest = to;
      moves = true;
      break;
    }
  }
  return nearest;
}

}  // namespace

std::vector<double> given_anew(const Lattice& lattice, const VertexOfPlace& vertex_of, std::size_t vertices,
                               std::span<std::uint32_t> nearest, unsigned threads,
                               ExecutionContext* context) {
  const std::span<const LatticeRun> runs(lattice.axis[2].runs);
  constexpr std::size_t kPerThread = 8;  // some take longer than others
  const std::size_t parts = threads <= 1 ? 1 : kPerThread * threads;
  parallel_for(threads, parts, [&](std::size_t part) {
    StopCheck stop(context);
    const std::size_t begin = runs.size() * part / parts, end = runs.size() * (part + 1) / parts;
    for_each_point(runs.subspan(begin, end - begin), [&](std::int32_t i, std::int32_t j, std::int32_t k,
                                                         std::uint32_t rank) {
      stop.did(10);
      nearest[rank] = vertex_of(lattice.spacing * Vec3{double(i), double(j), double(k)}, nearest[rank]);
    });
  });
  std::vector<double> share(vertices, 0);
  for (const std::uint32_t vertex : nearest) ++share[vertex];
  for (double& part : share) part /= static_cast<double>(lattice.points);
  return share;
}

SlicedLines sliced_lines(const SlicedLinesInput& input, std::span<std::uint32_t> nearest) {
  const std::vector<Vec3> places = positions(input.curve);
  std::vector<double> balls(places.size());
  parallel_for(input.threads, places.size(),
               [&](std::size_t v) { balls[v] = input.surface.thickness(places[v]); });
  const Adjacency beside = neighbours(places.size(), input.curve.segments);
  const std::vector<double> slices = given_anew(
      input.lattice, [&](const Vec3& at, std::uint32_t from) { return moved(places, beside, at, from); },
      places.size(), nearest, input.threads, input.context);
  const auto lines = polylines(places.size(), input.curve.segments);
  return {places, balls, slices, slice_radii({places, lines, slices, balls, input.solid.volume}), lines};
}

}  // namespace affskel::core
