#include "client/text/skeleton_text.h"

#include <algorithm>

#include "base/number_text.h"
#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

constexpr int kDigits = 4;

std::string percent(double share) {
  return base::rounded(100 * share, kDigits) + " %";
}

std::string betti(std::uint64_t components, std::uint64_t tunnels, std::uint64_t voids) {
  return std::to_string(components) + ", " + std::to_string(tunnels) + ", " + std::to_string(voids);
}

std::string place_text(const v1::CoarsePlace& place) {
  return "at (" + base::rounded(place.x(), kDigits) + ", " + base::rounded(place.y(), kDigits) + ", " +
         base::rounded(place.z(), kDigits) + ")";
}

}  // namespace

std::string skeleton_params_text(const v1::SkeletonParams& params) {
  return operator_word(params.operator_()) + (params.threshold() > 0
                                                  ? ", threshold " + base::to_text(params.threshold())
                                                  : ", default threshold");
}

std::string eroded_params_text(const v1::ErodedParams& params) {
  if (params.level_case() == v1::ErodedParams::kVolume) return "volume " + base::to_text(params.volume());
  const double fraction =
      params.level_case() == v1::ErodedParams::kFraction ? params.fraction() : wire::kErodedFraction;
  return "fraction " + base::to_text(fraction) + " of v0";
}

std::vector<std::pair<std::string, std::string>> quality_lines(const v1::SkeletonQuality& q) {
  std::vector<std::pair<std::string, std::string>> lines;
  lines.emplace_back("points", std::to_string(q.points()));
  if (q.points() > 0) {
    if (q.threshold() > 0) lines.emplace_back("threshold", base::to_text(q.threshold()));
    lines.emplace_back("inside", percent(q.inside_share()));
    lines.emplace_back("thickness", base::rounded(q.mean_thickness(), kDigits) + " voxels");
    lines.emplace_back("betti",
                       betti(q.components(), q.holes(), q.cavities()) + " (components, tunnels, voids)");
  }
  if (q.has_bridges())
    lines.emplace_back("bridges", std::to_string(q.bridges()) + " (ways through weaker shocks)");
  if (q.has_lattice()) {
    const v1::LatticeTopology& lattice = q.lattice();
    std::string text = betti(lattice.components(), lattice.holes(), lattice.cavities());
    if (q.fragments() > 0) text += ", " + std::to_string(q.fragments()) + " of the components left out";
    lines.emplace_back("betti_lattice", text);
  }
  lines.emplace_back("betti_solid", betti(q.solid_components(), static_cast<std::uint64_t>(q.solid_genus()),
                                          q.solid_cavities()));
  if (q.limbs() > 0)
    lines.emplace_back("limbs", std::to_string(q.limbs()) + " beyond the ridge, reached by lines");
  if (q.has_branches())
    lines.emplace_back("branches", std::to_string(q.branches()) + ", with " + base::counted(q.ends(), "end"));
  if (q.opened() > 0)
    lines.emplace_back("opened",
                       base::counted(q.opened(), "closed surface") + ": a cavity has no line round it");
  for (const auto& place : q.openings())
    lines.emplace_back("opened", place_text(place) + ", where E is least, " +
                                     base::rounded(place.size(), kDigits) + " from the surface");
  for (const auto& place : q.tunnels())
    lines.emplace_back("tunnel", place_text(place) + ", " + base::rounded(place.size(), kDigits) +
                                     " across: not the solid's, the lattice is too coarse there");
  for (const auto& place : q.unreached())
    lines.emplace_back("unreached", place_text(place) + ", the skeleton ends " +
                                        base::rounded(place.size(), kDigits) +
                                        " away: thinner than the spacing");
  const auto told = static_cast<std::uint32_t>(q.unreached_size());
  if (const auto more = q.unreached_ends() - std::min<std::uint32_t>(q.unreached_ends(), told); more > 0)
    lines.emplace_back("unreached", std::to_string(more) + " more ends, nearer to the skeleton");
  if (q.has_hausdorff_there() && q.has_hausdorff_back()) {
    lines.emplace_back("hausdorff", base::rounded(q.hausdorff_there(), kDigits) +
                                        " to the skeleton of threshold " +
                                        base::rounded(q.other_threshold(), kDigits) + ", " +
                                        base::rounded(q.hausdorff_back(), kDigits) + " back");
  }
  if (q.points() > 0) lines.emplace_back("chance_level", percent(q.chance_level()));
  if (!q.advice().empty()) lines.emplace_back("advice", q.advice());
  return lines;
}

}  // namespace affskel::client
