#include "core/skeleton_advice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "core/field.h"

namespace affskel::core {
namespace {

// Fewer distinct optimal normals than this cannot follow a curved level surface.
constexpr std::size_t kFewNormals = 60;

// Fewer sample points than this are less than 10 across a cube.
constexpr std::uint32_t kFewPoints = 1000;

std::string in_words(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

// Points of a sheet through a cube of so many points: their number to the power 2/3, rounded up.
std::size_t points_of_a_sheet(std::size_t points) {
  const double square = static_cast<double>(points) * static_cast<double>(points);
  double n = 1;
  while (n * n * n < square) ++n;
  return static_cast<std::size_t>(n);
}

std::vector<double> magnitudes(const std::vector<double>& divergence) {
  std::vector<double> result;
  result.reserve(divergence.size());
  for (const double h : divergence) result.push_back(std::abs(h));
  return result;
}

std::size_t distinct_normals(const OptimalDirections& optimal) {
  OptimalDirections used = optimal;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used.size() - (!used.empty() && used.back() == FieldValue::kNoDirection);
}

std::string on_threshold(std::vector<double> size, double threshold) {
  const double largest = *std::max_element(size.begin(), size.end());
  const std::string found = "no sample point has |H| above the threshold " + in_words(threshold);
  if (largest == 0) return found + ": the optimal normals do not change anywhere.";
  const auto wanted = size.begin() + static_cast<std::ptrdiff_t>(points_of_a_sheet(size.size()) - 1);
  std::nth_element(size.begin(), wanted, size.end(), std::greater<>());
  // Below the wanted point's |H| by more than writing it in three digits can raise it.
  const double least = *wanted > 0 ? *wanted : largest;
  const std::string lower = in_words(0.99 * least);
  const double bound = std::strtod(lower.c_str(), nullptr);
  const auto kept = std::count_if(size.begin(), size.end(), [&](double h) { return h > bound; });
  return found + "; the largest is " + in_words(largest) + ". --threshold " + lower + " would keep " +
         std::to_string(kept) + " of the " + std::to_string(size.size()) + " points.";
}

}  // namespace

std::string empty_skeleton_advice(const Lattice& lattice, const OptimalDirections& optimal,
                                  const std::vector<double>& divergence, ShockOperator shock_operator,
                                  double threshold) {
  if (divergence.empty()) return "there are no sample points.";
  std::string advice =
      std::string(name_of(shock_operator)) + ": " + on_threshold(magnitudes(divergence), threshold);
  const std::size_t normals = distinct_normals(optimal);
  if (normals < kFewNormals) {
    advice += " Only " + std::to_string(normals) +
              " directions are the optimum of some point, too few to show shocks well: submit with "
              "--directions triangles+sphere:1000.";
  }
  if (lattice.points < kFewPoints) {
    advice += " The lattice has only " + std::to_string(lattice.points) +
              " sample points: submit with a smaller spacing than " + in_words(lattice.spacing) +
              ", or --points 100000.";
  }
  return advice;
}

}  // namespace affskel::core
