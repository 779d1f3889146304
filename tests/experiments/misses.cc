// At how many points the infimum has missed a lesser piece: against the least of very many directions, which are
// followed down from where they find less.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "core/base/execution_context.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/infimum/least_chord.h"
#include "experiments.h"
#include "fields.h"
#include "infimum_solids.h"

namespace affskel::experiments {
namespace {

constexpr double kSame = 1e-6, kFar = 1e-3;

struct Missed {
  std::uint32_t points = 0, above = 0, far = 0;
  double worst = 0;
};

Missed look_for(const core::Mesh& mesh, double spacing, std::uint32_t directions, unsigned threads) {
  Fields fields(mesh, grid_round(mesh, spacing), kSeeds, threads);
  fields.go_on();
  const Job& job = fields.job();
  const auto known = [&](std::uint32_t p) {
    return std::ldexp(job.values[p].erosion, -3 * job.solid.exponent);
  };
  const core::DirectionSet many =
      core::make_directions(job.solid, "triangles+sphere:" + std::to_string(directions));
  core::Erosion all(job.solid, job.lattice, many, {.threads = threads});
  for (std::uint32_t p = 0; p < job.lattice.points; ++p) all.field().bound(p, known(p) * (1 - kSame));
  std::vector<std::uint32_t> list(many.size());
  std::iota(list.begin(), list.end(), 0U);
  core::ExecutionContext context;
  all.run(list, context);
  const core::PieceInput input(job.solid, threads);
  core::ChordDescent descent(input);
  const Cloud points = all_points(job);
  Missed missed{job.lattice.points, 0, 0, 0};
  for (std::uint32_t p = 0; p < job.lattice.points; ++p) {
    const core::FieldValue found = all.field().value(p);
    if (found.direction == core::FieldValue::kNoDirection) continue;
    core::LeastChord start;
    start.normal = many[found.direction];
    const core::Vec3 x = (1 / job.solid.scale()) * (points.place[p] - job.solid.centre);
    const double excess = known(p) / std::min(found.erosion, descent.descend(x, start).erosion) - 1;
    missed.above += excess > kSame;
    missed.far += excess > kFar;
    missed.worst = std::max(missed.worst, excess);
  }
  return missed;
}

}  // namespace

void miss_experiment(const Setting& setting, Report& report) {
  const std::uint32_t directions = setting.quick ? 5000 : 2000000;
  report.section("What the infimum misses");
  report.text(
      "Not published. All sample points of each solid against the least of " + std::to_string(directions) +
      " directions and the mesh's normals, followed down from where they find less than the refinement did.");
  Table table{{"solid", "points", "above by 1e-6", "by 1e-3", "the worst by"}, {}};
  for (const InfimumSolid& one : infimum_solids(setting)) {
    const Missed missed = look_for(one.mesh, one.spacing, directions, setting.threads);
    table.rows.push_back({one.name, format("%u", missed.points), format("%u", missed.above),
                          format("%u", missed.far), format("%.2g %%", 100 * missed.worst)});
    report.expect(one.name + ": share of points not above the least",
                  1 - double(missed.above) / double(missed.points), 0.998, 1);
  }
  report.table(table);
}

}  // namespace affskel::experiments
