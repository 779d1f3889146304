#include <algorithm>
#include <cmath>

#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/quality/interior_points.h"
#include "core/quality/similarity.h"
#include "experiments.h"
#include "job.h"
#include "limb_ends.h"
#include "limbed_solids.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

// Lattice steps along the longest side of the body's box, and voxels of the grid whose diagonal is the
// radius within which two skeletons count as alike.
constexpr double kStepsPerHeight = 180, kVoxelsPerHeight = 128;

// Shares of points within the radius: of the noisy skeleton near the clean one, of its ridges and curves alone, and back.
struct Shares {
  double there = 0, strong = 0, back = 0;
};

struct Level {
  double sigma;  // share of the box's diagonal
  std::vector<Shares> seeds;

  Shares mean() const {
    Shares sum;
    for (const Shares& one : seeds)
      sum = {sum.there + one.there, sum.strong + one.strong, sum.back + one.back};
    const auto count = static_cast<double>(seeds.size());
    return {sum.there / count, sum.strong / count, sum.back / count};
  }
  Shares worst() const {
    Shares least{1, 1, 1};
    for (const Shares& one : seeds)
      least = {std::min(least.there, one.there), std::min(least.strong, one.strong),
               std::min(least.back, one.back)};
    return least;
  }
};

std::string text_of(const Shares& shares) {
  return format("%.1f / %.1f / %.1f %%", 100 * shares.there, 100 * shares.strong, 100 * shares.back);
}

// Of the vertices that are no way's and no membrane's.
std::vector<core::Vec3> ridge_places(const Sheet& sheet) {
  std::vector<core::Vec3> places;
  for (std::size_t v = 0; v < sheet.kind.size(); ++v) {
    if (sheet.kind[v] == core::SkeletonKind::kRidge || sheet.kind[v] == core::SkeletonKind::kCurve)
      places.push_back(sheet.points.place[v]);
  }
  return places;
}

void study(const NamedMesh& body, const Setting& setting, Table& table, Report& report) {
  const double height = core::box_of(body.mesh).longest_side(), diagonal = core::box_diagonal(body.mesh);
  const double radius = std::sqrt(3.0) * height / kVoxelsPerHeight;
  const JobOptions options{height / (setting.quick ? kStepsPerHeight / 5 : kStepsPerHeight), "triangles",
                           core::FrameKind::kAxis, setting.threads};
  const Job clean = compute(body.mesh, options);
  const Sheet sheet = ridge_sheet_of(clean);
  const core::DistanceCurve chance(core::interior_points(clean.solid), sheet.points.place);
  for (Level level : {Level{0.005, {}}, Level{0.01, {}}}) {
    for (std::uint64_t seed = 1; seed <= setting.seeds; ++seed) {
      const Job noisy = compute(core::perturb(body.mesh, {level.sigma * diagonal, seed}), options);
      const Sheet other = ridge_sheet_of(noisy);
      const core::Similarity alike = core::similarity(sheet.points.place, other.points.place);
      level.seeds.push_back(
          {alike.b_in_a.share_within(radius),
           core::similarity(sheet.points.place, ridge_places(other)).b_in_a.share_within(radius),
           alike.a_in_b.share_within(radius)});
    }
    table.rows.push_back(
        {body.name, std::to_string(clean.lattice.points), std::to_string(sheet.points.size()),
         format("%llu, %llu", static_cast<unsigned long long>(sheet.betti.components),
                static_cast<unsigned long long>(sheet.betti.holes)),
         format("%.1f %%", 100 * chance.share_within(radius)), format("%.1f %%", 100 * level.sigma),
         text_of(level.mean()), text_of(level.worst())});
    if (!setting.quick && setting.meshes.empty()) {
      const Shares mean = level.mean();
      report.expect(format("%s, noise of %.1f %%: lesser mean share of the ridge", body.name.c_str(),
                           100 * level.sigma),
                    std::min(mean.there, mean.back), 0.9, 1);
      const Shares worst = level.worst();
      report.expect(
          format("%s, noise of %.1f %%: least share of the ridge", body.name.c_str(), 100 * level.sigma),
          std::min(worst.there, worst.back), 0.88, 1);
    }
  }
}

}  // namespace

void steadiness_experiment(const Setting& setting, Report& report) {
  report.section("The ridge under noise, seed by seed");
  report.text(format(
      "Not published: 1/%g of the body's height as spacing, %u seeds for each level of noise. Alike "
      "is what lies "
      "within the diagonal of a voxel of 1/%g of the height; *there* is the share of the noisy "
      "skeleton's points near "
      "the clean one, *ridge* that of its ridges and curves alone, *back* the reverse; the worst is taken of each by "
      "itself. Noise that makes tunnels, voids and spikes, as 1 %% does of a body of 5000 triangles, which then "
      "crosses itself, makes ways and membranes: the skeleton has the solid's topology. The chance level is "
      "the share of "
      "evenly spread inner points that lie as near.",
      kStepsPerHeight, setting.seeds, kVoxelsPerHeight));
  Table table{{"body", "sample points", "vertices", "pieces, tunnels", "chance", "noise",
               "mean there / ridge / back", "worst there / ridge / back"},
              {}};
  for (const NamedMesh& body : bodies_to_compare(setting)) study(body, setting, table, report);
  report.table(table);
}

}  // namespace affskel::experiments
