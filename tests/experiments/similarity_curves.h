#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "chart.h"
#include "core/quality/similarity.h"
#include "job.h"
#include "report.h"

namespace affskel::experiments {

/// The squared distance at which the published work reads its curves: (10^4)^2.
inline constexpr double kPublishedSquaredRadius = 1e8;

/// A squared radius with two digits, "1.2e5".
std::string squared_text(double squared);

/// Ways to a skeleton: the published one and ours.
enum class Operator { kZuckerHummel, kChords, kRidge };

const char* name_of(Operator shock_operator);

/// Its points: sample points over the threshold, places of equal chords, or vertices of the ridge.
Cloud skeleton_by(Operator shock_operator, const Job& job);

/// Two skeletons that should be alike.
struct Alike {
  std::string label;
  std::string colour;
  std::size_t points = 0, points_back = 0;
  core::Similarity curves;  ///< a: the skeleton that is the measure; b: the other
};

/// Skeletons compared with one, all of the same spacing.
struct SimilarityStudy {
  std::vector<Alike> alike;
  core::DistanceCurve chance;  ///< distances from it of points that know nothing of it
  double spacing = 0;

  /// The voxel diagonal, the radius that means something.
  double radius() const;
  /// Shares within the radius: b's points near a, and a's near b.
  double there(std::size_t n) const { return alike[n].curves.b_in_a.share_within(radius()); }
  double back(std::size_t n) const { return alike[n].curves.a_in_b.share_within(radius()); }
  double lesser_share(std::size_t n) const { return std::min(there(n), back(n)); }
  /// "98.1 / 97.5 %".
  std::string both_ways(std::size_t n) const;
};

/// The same by each operator.
struct OperatorStudies {
  SimilarityStudy zucker_hummel, chords, ridge;

  /// "98.1 / 97.5 %, chords 99.0 / 98.2 %, ridge 99.5 / 99.1 %": number n of the comparisons.
  std::string shares(std::size_t n) const;
  /// "chance 63 %, chords 50 %, ridge 45 %".
  std::string chance_levels() const;
};

/// Shares of similar points as in figures 6.17 and 6.21, both ways, at the squared voxel diagonal 3 dT^2 and
/// at the published squared radius; the area under the curve; and the Hausdorff distance.
Table similarity_table(const SimilarityStudy& study);

/// The same as curves over the squared radius.
/// @param published_share what the published work found at its squared radius, 0 .. 1.
Chart similarity_chart(const std::string& title, const SimilarityStudy& study, double published_share);

}  // namespace affskel::experiments
