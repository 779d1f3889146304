#include <algorithm>
#include <cmath>

#include "core/body.h"
#include "core/perturb.h"
#include "experiments.h"
#include "gallery.h"
#include "job.h"
#include "similarity_curves.h"

namespace affskel::experiments {
namespace {

constexpr double kPublishedShare = 0.94;

struct Level {
  std::string name, colour;
  double sigma;  // mesh units
};

std::vector<Level> levels(const core::Mesh& mesh) {
  const double diagonal = core::box_diagonal(mesh);
  return {{"1 unit", "#1b9e77", 1},
          {format("0.5 %% of the diagonal (%.0f units)", 0.005 * diagonal), "#d95f02", 0.005 * diagonal},
          {format("1 %% of the diagonal (%.0f units)", 0.01 * diagonal), "#7570b3", 0.01 * diagonal}};
}

Exhibit exhibit(const std::string& name, const Job& job, const Cloud& skeleton) {
  return {{name, format("%zu skeleton points", skeleton.size())},
          job.mesh,
          skeleton.place,
          skeleton.erosion,
          0.42 * job.lattice.spacing,
          {}};
}

// One body: its table; its pictures if `shown`.
void compare_body(const Setting& setting, std::uint32_t triangles, double dt, bool shown, Report& report) {
  const JobOptions options{dt, "triangles", core::FrameKind::kAxis, setting.threads};
  const core::Mesh mesh = core::make_body({triangles, setting.body_height});
  const Job clean = compute(mesh, options);
  const Cloud skeleton = zucker_hummel_skeleton(clean);
  std::vector<Alike> alike;
  std::vector<Exhibit> exhibits = {exhibit("without noise", clean, skeleton)};
  for (const Level& level : levels(mesh)) {
    const Job noisy = compute(core::perturb(mesh, {level.sigma, 1}), options);
    const Cloud other = zucker_hummel_skeleton(noisy);
    alike.push_back({level.name, level.colour, skeleton.size(), other.size(),
                     core::similarity(skeleton.place, other.place)});
    exhibits.push_back(exhibit(level.name, noisy, other));
  }
  const core::DistanceCurve chance(core::inner_points(clean.solid), skeleton.place);
  report.subsection(format("Body of %u triangles, dT = %g", triangles, dt));
  report.table(similarity_table(alike, chance, dt));
  const double diagonal = std::sqrt(3.0) * dt;
  const double floors[] = {0.8, 0.6, 0.5};
  for (std::size_t a = 0; a < alike.size(); ++a) {
    report.expect(format("noise of %s, body of %u: lesser share within a voxel diagonal",
                         alike[a].label.c_str(), triangles),
                  lesser_share(alike[a].curves, dt), floors[a], 1);
  }
  report.expect(format("body of %u, dT %g: chance level at the published radius", triangles, dt),
                chance.share_within(std::sqrt(kPublishedSquaredRadius)), 0.99, 1);
  if (!shown) return;
  report.drawing("noise",
                 svg_of(similarity_chart("Similar points under Gaussian vertex noise", alike, chance, dt,
                                         kPublishedShare)),
                 "Share of similar points over the squared radius, under noise");
  report.picture("noise", gallery(exhibits, {{Side::kFront, Side::kSide}, 2200}),
                 "The body and its skeleton without noise and with noise");
  report.compare(
      {format("noise of unit deviation, body of %u", triangles), "94 % at r^2 = 1e8",
       both_ways(alike[0].curves, diagonal) +
           format(" at r^2 = %.2g (chance %.0f %%)", 3 * dt * dt, 100 * chance.share_within(diagonal)),
       "agrees, with a radius that means something"});
  report.compare({format("noise of 0.5 and 1 %% of the diagonal, body of %u", triangles), "-",
                  both_ways(alike[1].curves, diagonal) + " and " + both_ways(alike[2].curves, diagonal),
                  "-"});
}

}  // namespace

void noise_experiment(const Setting& setting, Report& report) {
  report.section("Noise (6.3, figures 6.15 to 6.17)");
  report.text(
      "Published: vertices moved at random, from a normal distribution of standard deviation 1; 94 % similar "
      "points "
      "at a squared distance of 1e8, in skeletons of about 5000 points. That is a distance of 10,000 units, "
      "more "
      "than half of the height of a body 18,000 units tall: at that radius any two sets of points in the "
      "body are "
      "alike, and a share *below* 100 % tells more about stray points far away than about noise. The author "
      "asks what a "
      "proper threshold would be and names the voxel diagonal, r^2 = 3 dT^2 = 1.2e5 at dT = 200. The tables "
      "give "
      "both, each way: *there* is the share of the noisy skeleton's points that lie near the clean one, "
      "*back* "
      "the reverse, which is what shows a part that went missing. The chance level is the share of evenly "
      "spread "
      "inner points that lie as near to the skeleton. One unit in 18,000 is hardly noise; the other rows "
      "have "
      "100 and 200 times as much, where a fine mesh folds over.");
  const double dt = setting.spacing();
  if (setting.quick) return compare_body(setting, 292, dt, true, report);
  compare_body(setting, 1000, dt, true, report);
  compare_body(setting, 292, dt, false, report);
  compare_body(setting, 5000, dt, false, report);
  compare_body(setting, 1000, dt / 2, false, report);
}

}  // namespace affskel::experiments
