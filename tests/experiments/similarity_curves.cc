#include "similarity_curves.h"

#include <cmath>

#include "sheet.h"

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

std::string squared_text(double squared) {
  const int power = static_cast<int>(std::floor(std::log10(squared) + 1e-9));
  return format("%.2ge%d", squared / std::pow(10.0, power), power);
}

const char* name_of(Operator shock_operator) {
  switch (shock_operator) {
    case Operator::kZuckerHummel:
      return "zucker-hummel";
    case Operator::kChords:
      return "chords";
    case Operator::kRidge:
      break;
  }
  return "ridge";
}

Cloud skeleton_by(Operator shock_operator, const Job& job) {
  switch (shock_operator) {
    case Operator::kZuckerHummel:
      return zucker_hummel_skeleton(job);
    case Operator::kChords:
      return chord_sheet_of(job).points;
    case Operator::kRidge:
      break;
  }
  return ridge_sheet_of(job).points;
}

double SimilarityStudy::radius() const {
  return std::sqrt(3.0) * spacing;
}

std::string SimilarityStudy::both_ways(std::size_t n) const {
  return format("%.1f / %.1f %%", 100 * there(n), 100 * back(n));
}

std::string OperatorStudies::shares(std::size_t n) const {
  return zucker_hummel.both_ways(n) + ", chords " + chords.both_ways(n) + ", ridge " + ridge.both_ways(n);
}

std::string OperatorStudies::chance_levels() const {
  const auto level = [](const SimilarityStudy& s) { return 100 * s.chance.share_within(s.radius()); };
  return format("chance %.0f %%, chords %.0f %%, ridge %.0f %%", level(zucker_hummel), level(chords),
                level(ridge));
}

Table similarity_table(const SimilarityStudy& study) {
  const double published = std::sqrt(kPublishedSquaredRadius);
  Table table{{"comparison", "points",
               "within r^2 = " + squared_text(study.radius() * study.radius()) + ", there / back",
               "within r^2 = 1e8, there / back", "area under the curve to 1e8, there / back",
               "greatest distance, there / back"},
              {}};
  for (std::size_t n = 0; n < study.alike.size(); ++n) {
    const Alike& a = study.alike[n];
    const core::DistanceCurve &there = a.curves.b_in_a, &back = a.curves.a_in_b;
    table.rows.push_back(
        {a.label, format("%zu, %zu", a.points, a.points_back), study.both_ways(n),
         format("%.1f / %.1f %%", 100 * there.share_within(published), 100 * back.share_within(published)),
         format("%.4f / %.4f", there.area_under_squared(published), back.area_under_squared(published)),
         format("%.0f / %.0f", there.hausdorff(), back.hausdorff())});
  }
  const core::DistanceCurve& chance = study.chance;
  table.rows.push_back({"chance level: any points of the inside", "-",
                        format("%.1f %%", 100 * chance.share_within(study.radius())),
                        format("%.1f %%", 100 * chance.share_within(published)),
                        format("%.4f", chance.area_under_squared(published)),
                        format("%.0f", chance.hausdorff())});
  return table;
}

Chart similarity_chart(const std::string& title, const SimilarityStudy& study, double published_share) {
  Chart chart;
  chart.title = title;
  chart.x = {"squared radius r^2, mesh units squared", kLowest, kHighest, true};
  chart.y = {"share of points within r, %", 0, 100, false};
  for (const Alike& a : study.alike) {
    chart.lines.push_back({a.label, a.colour, false, false, curve(a.curves.b_in_a)});
    chart.lines.push_back({"  back", a.colour, true, false, curve(a.curves.a_in_b)});
  }
  chart.lines.push_back({"chance level", "#999999", false, false, curve(study.chance)});
  chart.remarks.push_back({study.radius() * study.radius(), 0, "voxel diagonal", true});
  chart.remarks.push_back({kPublishedSquaredRadius, 100 * published_share,
                           format("published: %.0f %%", 100 * published_share), false});
  return chart;
}

}  // namespace affskel::experiments
