#include "core/quality/skeleton_advice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include "base/number_text.h"
#include "core/base/matrix3.h"
#include "core/base/plain_math.h"
#include "core/base/symmetric_eigen.h"
#include "core/erosion/field.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_points.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

// Fewer distinct optimal normals than this cannot follow a curved level surface.
constexpr std::size_t kFewNormals = 60;

// How many more directions than the mesh's triangles are advised, of a sheet and of points.
constexpr std::size_t kMoreOfSheet = 2000, kMoreOfPoints = 1000;

// Fewer sample points than this are less than 10 across a cube.
constexpr std::uint32_t kFewPoints = 1000;

// Vertices of a skeleton that is hardly more than a point: so many, or a quarter of the points across a cube.
constexpr double kFewVertices = 4, kFewAcross = 0.25;

// Spacings from the surface: a plate that is no deeper may have no sheet yet, though it would have one.
constexpr float kShallow = 3;

// A point farther from the skeleton than so many radii of the solid there, and spacings, lies bare; about so many are
// looked at, and this share of them tells.
constexpr double kBareRadii = 4, kBareSpacings = 3, kMostBare = 0.2;
constexpr std::size_t kLookedAt = 20000;

// Of the vertices of a skeleton of `ridge`: below this share on a ridge hardly any is.  A lower threshold, by this
// factor.
constexpr double kLittleRidge = 0.1, kLowerThreshold = 3;

// More than by rounding, and so much that limbs are others.
constexpr double kStretched = 1 + 1e-6, kOtherLimbs = 1.5;

// A sheet of less than this share of the points of one through a cube is hardly there.
constexpr double kLittleSheet = 0.1;

// Points of a sheet through a cube of so many points: their number to the power 2/3, rounded up.
std::size_t points_of_a_sheet(std::size_t points) {
  const double square = static_cast<double>(points) * static_cast<double>(points);
  double n = 1;
  while (n * n * n < square) ++n;
  return static_cast<std::size_t>(n);
}

std::size_t distinct_normals(const OptimalDirections& optimal) {
  OptimalDirections used = optimal;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used.size() - (!used.empty() && used.back() == FieldValue::kNoDirection);
}

// @param size H, of which the magnitudes count.
Advice on_threshold(std::vector<double> size, double threshold) {
  for (double& h : size) h = std::abs(h);
  const double largest = *std::max_element(size.begin(), size.end());
  const std::string found = "no sample point has |H| above the threshold " + base::rounded(threshold, 3);
  if (largest == 0) return {found + ": the optimal normals do not change anywhere.", {}};
  const auto wanted = size.begin() + static_cast<std::ptrdiff_t>(points_of_a_sheet(size.size()) - 1);
  std::nth_element(size.begin(), wanted, size.end(), std::greater<>());
  // Lowered by 1 %, more than rounding to three digits can raise it.
  const double least = *wanted > 0 ? *wanted : largest;
  const std::string lower = base::rounded(0.99 * least, 3);
  const double bound = std::strtod(lower.c_str(), nullptr);
  const auto kept = std::count_if(size.begin(), size.end(), [&](double h) { return h > bound; });
  return {found + "; the largest is " + base::rounded(largest, 3) + ". A threshold of " + lower +
              " would keep " + std::to_string(kept) + " of the " + std::to_string(size.size()) + " points.",
          {{"threshold", lower}}};
}

void add_on_few_points(const Lattice& lattice, Advice& advice) {
  if (lattice.points >= kFewPoints) return;
  advice.text += " The lattice has only " + base::counted(lattice.points, "sample point") +
                 ": submit with a smaller spacing than " + base::rounded(lattice.spacing, 3) + ".";
  advice.settings.push_back({"points", "100000"});
}

// The angle between two normals, from their opening (see ChordShock), in whole degrees.
std::string degrees(double opening) {
  const double o = std::clamp(opening, 0.0, 1.0);
  const double angle = 2 * plain_angle(std::sqrt(o), std::sqrt(1 - o)) * (180 / std::numbers::pi);
  return std::to_string(std::lrint(angle));
}

// How many times as much the lattice's frame stretches the mesh one way as another.
double stretch_of(const Lattice& lattice) {
  const Matrix3 f = frame_matrix(lattice);
  Matrix3 squares{};
  for (const Vec3& axis : f) squares = squares + outer(axis, axis);
  const auto lengths = symmetric_eigen(squares).values;
  return std::sqrt(lengths[0] / lengths[2]);
}

void add_on_directions(std::size_t advised, std::size_t more_directions, Advice& advice) {
  if (more_directions < advised)
    advice.settings.push_back({"directions", "triangles+sphere:" + std::to_string(advised)});
}

Advice on_turn(const Lattice& lattice, const ShockCensus& census, double strong_turn,
               std::size_t more_directions) {
  Advice advice{"the normals on the two sides of a shock differ by " + degrees(census.max_turn) +
                    " degrees at most, and a skeleton needs " + degrees(strong_turn) + ".",
                {}};
  if (stretch_of(lattice) > kStretched) {
    advice.text +=
        " The lattice's frame is stretched, which makes a flat solid as thick as it is wide: submit with "
        "the frame axis or pca.";
    advice.settings.push_back({"frame", "axis"});
  }
  advice.text +=
      std::string(" The solid may have no other skeleton than its centre, as a ball has; else submit with ") +
      (more_directions < kMoreOfSheet ? "more directions or " : "") + "a smaller spacing.";
  add_on_directions(kMoreOfSheet, more_directions, advice);
  return advice;
}

// Half the spacing shows features half as large.
Advice with_more_points(const Lattice& lattice, const std::string& why) {
  constexpr std::uint64_t kMore = 8, kRound = 10000;
  const std::string points = std::to_string((kMore * lattice.points + kRound - 1) / kRound * kRound);
  return {why + " Submit with a smaller spacing than " + base::rounded(lattice.spacing, 3) + ".",
          {{"points", points}}};
}

std::string words(const BettiNumbers& betti) {
  return base::counted(betti.components, "piece") + ", " + base::counted(betti.holes, "tunnel") + " and " +
         base::counted(betti.cavities, "void");
}

// The share of the sample points that lie farther from the skeleton than twice the thickness there, where it is much.
std::optional<double> bare_share(const Lattice& lattice, std::span<const float> radius,
                                 std::span<const Vec3> places, std::span<const std::uint32_t> points) {
  if (places.empty()) return std::nullopt;
  const PointIndex skeleton(places);
  const std::size_t step = 1 + lattice.points / kLookedAt;
  std::size_t looked_at = 0, bare = 0;
  for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
    if (rank % step != 0) return;
    const auto nearest = skeleton.find(lattice.spacing * Vec3{double(i), double(j), double(k)});
    const float thick = std::max(radius[rank], radius[points[nearest.number]]);
    ++looked_at;
    bare += nearest.distance > lattice.spacing * (kBareRadii * static_cast<double>(thick) + kBareSpacings);
  });
  const double share = static_cast<double>(bare) / static_cast<double>(looked_at);
  return share > kMostBare ? std::optional(share) : std::nullopt;
}

Advice if_bare(const std::optional<double>& share, const std::string& farther_from) {
  if (!share) return {};
  return {base::rounded(100 * *share, 2) + " % of the solid are farther from " + farther_from, {}};
}

Advice on_significance(const ShockCensus& census, double significance) {
  const std::string lower = base::rounded(0.99 * census.max_piece_share, 3);
  return {"all " + std::to_string(census.strong) + " strong shocks lie in pieces below the significance " +
              base::rounded(significance, 3) + "; the heaviest weighs " +
              base::rounded(census.max_piece_share, 3) + " of its sheet. A threshold of " + lower +
              " would keep it, one of 1e-9 all.",
          {{"threshold", lower}}};
}

}  // namespace

Advice coarse_lattice_advice(const Lattice& lattice, const BettiNumbers& of_lattice,
                             const BettiNumbers& solid, bool surfaces_meet) {
  if (of_lattice == solid) return {};
  if (surfaces_meet) {
    return {
        "it has the " + words(of_lattice) + " of the sample points, the solid has " + words(solid) +
            ": its surfaces cross or touch each other, and are counted each by itself, whereas what overlaps is "
            "one here.",
        {}};
  }
  return with_more_points(lattice, "it has the " + words(of_lattice) +
                                       " of the sample points, the solid has " + words(solid) +
                                       ": they are too few for something as thin as what differs.");
}

Advice small_skeleton_advice(const Lattice& lattice, std::span<const float> radius, std::size_t vertices) {
  const float depth = radius.empty() ? 0 : *std::max_element(radius.begin(), radius.end());
  if (depth <= 1) {
    return with_more_points(
        lattice,
        "all sample points lie next to the surface, at most two across the solid where it is thickest: "
        "too few to tell its middle.");
  }
  const double across = std::cbrt(static_cast<double>(lattice.points));
  if (static_cast<double>(vertices) > std::max(kFewVertices, kFewAcross * across)) return {};
  const std::string point = "it is hardly more than a point, where E is greatest";
  if (depth <= kShallow) {
    return with_more_points(lattice, point + "; the sample points, " + base::rounded(2 * depth, 2) +
                                         " across the solid where it is thickest, may be too few for more.");
  }
  return {
      point +
          ", as of a ball, a cube, or a bowl, whose wall is cut from outside only; more points would hardly show more.",
      {}};
}

Advice bare_solid_advice(const Lattice& lattice, std::span<const float> radius, std::span<const Vec3> places,
                         std::span<const std::uint32_t> points) {
  return if_bare(
      bare_share(lattice, radius, places, points),
      "it than twice the thickness there, for want of a ridge as strong as the threshold: it may be weaker "
      "there, or none, as in walls that are bent, of a bowl or a mug, where E grows up to the hollow side.");
}

Advice flat_solid_advice(const Lattice& lattice, std::span<const float> radius, std::span<const Vec3> places,
                         std::span<const std::uint32_t> points) {
  return if_bare(
      bare_share(lattice, radius, places, points),
      "the lines than twice the thickness there: lines tell little of plates and shells. The operator ridge "
      "has their sheets.");
}

Advice little_ridge_advice(double share, double threshold, double strongest) {
  if (share >= kLittleRidge) return {};
  const std::string told =
      (share == 0 ? "none" : "only " + base::rounded(100 * share, 2) + " %") +
      " of it lies on a ridge as strong as the threshold; the rest are ways and membranes, which keep the "
      "solid's topology.";
  if (!(strongest > 0)) return {told + " None is an eighth as strong.", {}};
  const std::string lower = base::rounded(std::min(threshold, strongest) / kLowerThreshold, 2);
  return {told + " A threshold of " + lower + " may find more.", {{"threshold", lower}}};
}

Advice stretched_limbs_advice(const Lattice& lattice) {
  const double stretch = stretch_of(lattice);
  if (!(stretch >= kOtherLimbs)) return {};
  return {
      "limbs are told in the lattice's frame, in which the solid is stretched " + base::rounded(stretch, 2) +
          " times as much one way as another: what is thin here may be too thick there to be a limb. In the "
          "frame axis they are told as they are.",
      {{"frame", "axis"}}};
}

Advice stray_sheet_advice(const Lattice& lattice, std::span<const float> radius, std::span<const Vec3> places,
                          std::span<const std::uint32_t> points, const BettiNumbers& sheet,
                          const BettiNumbers& solid) {
  if (places.empty()) return {};
  constexpr const char* kOther = " The operator ridge may have more.";
  if (const std::optional<double> share = bare_share(lattice, radius, places, points)) {
    return if_bare(
        share, std::string("it than twice the thickness there: equal chords of clearly different directions "
                           "are missing.") +
                   kOther);
  }
  const double whole = static_cast<double>(points_of_a_sheet(lattice.points));
  if (static_cast<double>(places.size()) < kLittleSheet * whole) {
    return {"it has only " + base::counted(places.size(), "point") +
                ", a sheet through the whole solid about " + base::rounded(whole, 2) +
                ": where a solid is round, equal chords hardly tell one." + kOther,
            {}};
  }
  if (sheet == solid) return {};
  return {"it has " + words(sheet) + ", the solid " + words(solid) +
              ": it is torn, or has stray pieces. The operator ridge keeps the solid's.",
          {}};
}

Advice empty_skeleton_advice(const Lattice& lattice, const OptimalDirections& optimal,
                             const std::vector<double>& divergence, ShockOperator shock_operator,
                             double threshold, std::size_t more_directions) {
  if (divergence.empty()) return {"there are no sample points.", {}};
  Advice advice = on_threshold(divergence, threshold);
  advice.text.insert(0, std::string(name_of(shock_operator)) + ": ");
  const std::size_t normals = distinct_normals(optimal);
  if (normals < kFewNormals) {
    advice.text += " Only " + base::counted(normals, "direction is", "directions are") +
                   " the optimum of some point, too few to show shocks well" +
                   (more_directions < kMoreOfPoints ? ": submit with more." : ".");
    add_on_directions(kMoreOfPoints, more_directions, advice);
  }
  add_on_few_points(lattice, advice);
  return advice;
}

Advice empty_sheet_advice(const Lattice& lattice, const ShockCensus& census, double significance,
                          double strong_turn, std::size_t more_directions) {
  if (census.strong > 0) return on_significance(census, significance);
  Advice advice;
  if (census.wide > 0) {
    advice.text = "shocks are too near the surface: at none of the " + std::to_string(census.wide) +
                  " where equal chords clearly differ is E " +
                  base::rounded(ChordConstants().min_erosion, 3) +
                  " of the volume. Submit with a smaller spacing.";
  } else if (census.candidates > 0) {
    advice = on_turn(lattice, census, strong_turn, more_directions);
  } else {
    advice.text =
        std::string("nowhere do two different chords have the same volume. Submit with a smaller spacing") +
        (more_directions < kMoreOfSheet ? " or more directions." : ".");
    add_on_directions(kMoreOfSheet, more_directions, advice);
  }
  add_on_few_points(lattice, advice);
  return advice;
}

Advice low_barriers_advice(std::span<const Triangle> triangles, std::span<const Segment> segments,
                           std::span<const double> barrier, double least) {
  double greatest = 0;
  for (const auto& [a, b, c] : triangles)
    greatest = std::max(greatest, std::min({barrier[a], barrier[b], barrier[c]}));
  for (const auto& [a, b] : segments) greatest = std::max(greatest, std::min(barrier[a], barrier[b]));
  const std::string none = std::string("no ") +
                           (triangles.empty() ? "segment of the curves" : "triangle of the sheet") +
                           " has a barrier of " + base::rounded(least, 3) + ": ";
  if (greatest <= 0) return {none + "the normals jump nowhere, they only turn fast.", {}};
  const std::string lower = base::rounded(0.99 * greatest, 3);
  return {none + "the greatest is " + base::rounded(greatest, 3) + ". A least barrier of " + lower +
              " would keep one.",
          {{"min_barrier", lower}}};
}

}  // namespace affskel::core
