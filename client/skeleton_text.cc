#include "client/skeleton_text.h"

#include <google/protobuf/descriptor.h>

#include "client/error.h"
#include "client/exporters/numbers.h"
#include "client/job_json.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

constexpr int kDigits = 4;

std::string percent(double share) {
  return rounded(100 * share, kDigits) + " %";
}

std::string betti(std::uint64_t components, std::uint64_t tunnels, std::uint64_t voids) {
  return std::to_string(components) + ", " + std::to_string(tunnels) + ", " + std::to_string(voids);
}

}  // namespace

const std::vector<std::string>& operator_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    const auto* type = v1::Operator_descriptor();
    for (int i = 0; i < type->value_count(); ++i) {
      if (type->value(i)->number() != 0) list.push_back(enum_word(*type->value(i)));
    }
    return list;
  }();
  return names;
}

v1::Operator operator_named(const std::string& name) {
  const auto* type = v1::Operator_descriptor();
  std::string possible;
  for (int i = 0; i < type->value_count(); ++i) {
    const std::string word = enum_word(*type->value(i));
    if (word.empty()) continue;
    if (word == name) return static_cast<v1::Operator>(type->value(i)->number());
    possible += (possible.empty() ? "" : ", ") + word;
  }
  throw ClientError(ExitCode::kUsage, "no operator '" + name + "'; possible are " + possible);
}

std::string skeleton_params_text(const v1::SkeletonParams& params) {
  const auto* value = v1::Operator_descriptor()->FindValueByNumber(params.operator_());
  const std::string name = value == nullptr || value->number() == 0 ? "zucker-hummel" : enum_word(*value);
  return name +
         (params.threshold() > 0 ? ", threshold " + shortest(params.threshold()) : ", default threshold");
}

std::string eroded_params_text(const v1::ErodedParams& params) {
  if (params.level_case() == v1::ErodedParams::kVolume) return "volume " + shortest(params.volume());
  const double fraction =
      params.level_case() == v1::ErodedParams::kFraction ? params.fraction() : wire::kErodedFraction;
  return "fraction " + shortest(fraction) + " of v0";
}

std::vector<std::pair<std::string, std::string>> quality_lines(const v1::SkeletonQuality& q) {
  std::vector<std::pair<std::string, std::string>> lines;
  lines.emplace_back("points", std::to_string(q.points()));
  if (q.points() > 0) {
    if (q.threshold() > 0) lines.emplace_back("threshold", shortest(q.threshold()));
    lines.emplace_back("inside", percent(q.inside_share()));
    lines.emplace_back("thickness", rounded(q.mean_thickness(), kDigits) + " voxels");
    lines.emplace_back("betti",
                       betti(q.components(), q.holes(), q.cavities()) + " (components, tunnels, voids)");
  }
  if (q.has_bridges())
    lines.emplace_back("bridges", std::to_string(q.bridges()) + " (ways through weaker shocks)");
  lines.emplace_back("betti_solid", betti(q.solid_components(), static_cast<std::uint64_t>(q.solid_genus()),
                                          q.solid_cavities()));
  if (q.has_hausdorff_there() && q.has_hausdorff_back()) {
    lines.emplace_back("hausdorff", rounded(q.hausdorff_there(), kDigits) + " to the skeleton of threshold " +
                                        rounded(q.other_threshold(), kDigits) + ", " +
                                        rounded(q.hausdorff_back(), kDigits) + " back");
  }
  if (q.points() > 0) lines.emplace_back("chance_level", percent(q.chance_level()));
  if (!q.advice().empty()) lines.emplace_back("advice", q.advice());
  return lines;
}

}  // namespace affskel::client
