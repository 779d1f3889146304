#include "similarity_curves.h"

#include <algorithm>
#include <cmath>

namespace affskel::experiments {
namespace {

constexpr double kLowest = 1e2, kHighest = 1e9;  // squared radii of the chart

std::vector<std::pair<double, double>> curve(const core::DistanceCurve& distances) {
  std::vector<std::pair<double, double>> points;
  for (int step = 0; step <= 140; ++step) {
    const double squared = kLowest * std::pow(kHighest / kLowest, step / 140.0);
    points.push_back({squared, 100 * distances.share_within(std::sqrt(squared))});
  }
  return points;
}

}  // namespace

std::string both_ways(const core::Similarity& curves, double radius) {
  return format("%.1f / %.1f %%", 100 * curves.b_in_a.share_within(radius),
                100 * curves.a_in_b.share_within(radius));
}

double lesser_share(const core::Similarity& curves, double spacing) {
  const double radius = std::sqrt(3.0) * spacing;
  return std::min(curves.a_in_b.share_within(radius), curves.b_in_a.share_within(radius));
}

Table similarity_table(const std::vector<Alike>& alike, const core::DistanceCurve& chance, double spacing) {
  const double diagonal = std::sqrt(3.0) * spacing, published = std::sqrt(kPublishedSquaredRadius);
  Table table{{"comparison", "points", format("within r^2 = %.2g, there / back", 3 * spacing * spacing),
               "within r^2 = 1e8, there / back", "area under the curve to 1e8, there / back",
               "greatest distance, there / back"},
              {}};
  for (const Alike& a : alike) {
    table.rows.push_back({a.label, format("%zu, %zu", a.points, a.points_back), both_ways(a.curves, diagonal),
                          both_ways(a.curves, published),
                          format("%.4f / %.4f", a.curves.b_in_a.area_under_squared(published),
                                 a.curves.a_in_b.area_under_squared(published)),
                          format("%.0f / %.0f", a.curves.b_in_a.hausdorff(), a.curves.a_in_b.hausdorff())});
  }
  table.rows.push_back(
      {"chance level: any points of the inside", "-", format("%.1f %%", 100 * chance.share_within(diagonal)),
       format("%.1f %%", 100 * chance.share_within(published)),
       format("%.4f", chance.area_under_squared(published)), format("%.0f", chance.hausdorff())});
  return table;
}

Chart similarity_chart(const std::string& title, const std::vector<Alike>& alike,
                       const core::DistanceCurve& chance, double spacing, double published_share) {
  Chart chart;
  chart.title = title;
  chart.x = {"squared radius r^2, mesh units squared", kLowest, kHighest, true};
  chart.y = {"share of points within r, %", 0, 100, false};
  for (const Alike& a : alike) {
    chart.lines.push_back({a.label, a.colour, false, false, curve(a.curves.b_in_a)});
    chart.lines.push_back({"  back", a.colour, true, false, curve(a.curves.a_in_b)});
  }
  chart.lines.push_back({"chance level", "#999999", false, false, curve(chance)});
  chart.remarks.push_back({3 * spacing * spacing, 0, "voxel diagonal", true});
  chart.remarks.push_back({kPublishedSquaredRadius, 100 * published_share,
                           format("published: %.0f %%", 100 * published_share), false});
  return chart;
}

}  // namespace affskel::experiments
