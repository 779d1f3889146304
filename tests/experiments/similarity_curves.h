#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "chart.h"
#include "core/similarity.h"
#include "report.h"

namespace affskel::experiments {

/// The squared distance at which the published work reads its curves: (10^4)^2.
inline constexpr double kPublishedSquaredRadius = 1e8;

/// Two skeletons that should be alike.
struct Alike {
  std::string label;
  std::string colour;
  std::size_t points = 0, points_back = 0;
  core::Similarity curves;  ///< a: the skeleton that is the measure; b: the other
};

/// Shares of similar points as in figures 6.17 and 6.21, both ways, at the squared voxel diagonal 3 dT^2 and
/// at the published squared radius, and the Hausdorff distance.
/// @param chance distances of points that know nothing of the skeleton a.
Table similarity_table(const std::vector<Alike>& alike, const core::DistanceCurve& chance, double spacing);

/// The same as curves over the squared radius.
/// @param published_share what the published work found at its squared radius, 0 .. 1.
Chart similarity_chart(const std::string& title, const std::vector<Alike>& alike,
                       const core::DistanceCurve& chance, double spacing, double published_share);

/// Share of a's points near b and of b's near a, within the voxel diagonal: the lesser.
double lesser_share(const core::Similarity& curves, double spacing);

/// "98.1 / 97.5 %": b's points near a, then a's near b, within the radius.
std::string both_ways(const core::Similarity& curves, double radius);

}  // namespace affskel::experiments
