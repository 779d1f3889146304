// A comparison as a table, as CSV, as JSON and as a plot.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/comparison/comparison.h"
#include "client/text/key_line.h"
#include "core/files/numbers.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

// In per cent, without the sign.
std::string column_share(double share) {
  return core::with_decimals(100 * share, 2);
}

double shown_radius(const Comparison& c, double radius) {
  return c.squared ? radius * radius : radius;
}

double area(const Comparison& c, const core::DistanceCurve& curve) {
  return c.squared ? curve.area_under_squared(c.radii.back()) : curve.area_under(c.radii.back());
}

// The columns of table and CSV, in their order.
struct Column {
  const char* title;  // for people
  const char* name;   // for CSV and JSON
  const core::DistanceCurve* curve;
};

std::vector<Column> columns_of(const Comparison& c) {
  std::vector<Column> columns = {{"A in B %", "a_in_b", &c.curves.a_in_b},
                                 {"B in A %", "b_in_a", &c.curves.b_in_a}};
  if (c.chance) {
    columns.push_back({"chance in B %", "chance_in_b", &c.chance->in_b});
    columns.push_back({"chance in A %", "chance_in_a", &c.chance->in_a});
  }
  return columns;
}

std::string padded(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string table_text(const Comparison& c) {
  const std::vector<Column> columns = columns_of(c);
  constexpr std::size_t kRadius = 12, kGap = 2;
  std::string text = padded(c.squared ? "r^2" : "r", kRadius);
  for (const Column& column : columns) text += std::string(kGap, ' ') + column.title;
  text += "\n";
  for (const double radius : c.radii) {
    text += padded(base::rounded(shown_radius(c, radius), 7), kRadius);
    for (const Column& column : columns) {
      text += padded(column_share(column.curve->share_within(radius)),
                     kGap + std::string_view(column.title).size());
    }
    text += "\n";
  }
  return text;
}

std::string side_text(const ComparedPoints& side) {
  return side.file + " (" + base::counted(side.points.size(), "point") +
         (side.from_surface ? " spread over it)" : ")");
}

std::string there_and_back(const std::string& a_in_b, const std::string& b_in_a, const char* unit) {
  return a_in_b + unit + " of A in B, " + b_in_a + unit + " of B in A";
}

ordered_json shares_json(const Comparison& c, double radius) {
  ordered_json row = {{"radius", radius}, {"squared_radius", radius * radius}};
  for (const Column& column : columns_of(c)) row[column.name] = column.curve->share_within(radius);
  return row;
}

ordered_json side_json(const ComparedPoints& side) {
  return {{"file", side.file}, {"points", side.points.size()}, {"surface", side.from_surface}};
}

PlotCurve plotted(const Comparison& c, const core::DistanceCurve& curve, PlotCurve style) {
  constexpr int kSteps = 400;
  const double last = c.radii.back();
  for (int i = 0; i <= kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    const double radius = c.squared ? std::sqrt(part) * last : part * last;
    style.points.emplace_back(shown_radius(c, last) * part, curve.share_within(radius));
  }
  return style;
}

}  // namespace

std::string comparison_text(const Comparison& c) {
  const core::Similarity& s = c.curves;
  const std::string to = " (up to " + std::string(c.squared ? "r^2 = " : "r = ") +
                         base::rounded(shown_radius(c, c.radii.back()), 7) + ")";
  std::string text =
      table_text(c) + "\n" + key_line("A", side_text(c.a)) + key_line("B", side_text(c.b)) +
      key_line(c.squared ? "radius squared" : "radius", base::rounded(shown_radius(c, c.radius), 7)) +
      key_line("within radius", there_and_back(column_share(s.a_in_b.share_within(c.radius)),
                                               column_share(s.b_in_a.share_within(c.radius)), " %"));
  if (c.chance) {
    text +=
        key_line("chance", column_share(c.chance->in_b.share_within(c.radius)) + " % of the solid near B, " +
                               column_share(c.chance->in_a.share_within(c.radius)) + " % near A");
  }
  text += key_line(
      "area under curve",
      there_and_back(base::rounded(area(c, s.a_in_b), 4), base::rounded(area(c, s.b_in_a), 4), "") + to);
  return text + key_line("Hausdorff", base::rounded(s.a_in_b.hausdorff(), 7) + " from A to B, " +
                                          base::rounded(s.b_in_a.hausdorff(), 7) + " from B to A");
}

std::string comparison_csv(const Comparison& c) {
  const std::vector<Column> columns = columns_of(c);
  std::string text = "radius,squared_radius";
  for (const Column& column : columns) text += std::string(",") + column.name;
  text += "\n";
  for (const double radius : c.radii) {
    core::append_exact(text, radius);
    text.push_back(',');
    core::append_exact(text, radius * radius);
    for (const Column& column : columns) {
      text.push_back(',');
      core::append_exact(text, column.curve->share_within(radius));
    }
    text.push_back('\n');
  }
  return text;
}

ordered_json comparison_json(const Comparison& c) {
  ordered_json curve = ordered_json::array();
  for (const double radius : c.radii) curve.push_back(shares_json(c, radius));
  ordered_json under = {{"to_radius", c.radii.back()}}, under_squared = under;
  for (const Column& column : columns_of(c)) {
    under[column.name] = column.curve->area_under(c.radii.back());
    under_squared[column.name] = column.curve->area_under_squared(c.radii.back());
  }
  ordered_json document = {
      {"a", side_json(c.a)},
      {"b", side_json(c.b)},
      {"at_radius", shares_json(c, c.radius)},
      {"area_under_curve", under},
      {"area_under_squared_curve", under_squared},
      {"hausdorff", {{"a_to_b", c.curves.a_in_b.hausdorff()}, {"b_to_a", c.curves.b_in_a.hausdorff()}}},
      {"curve", curve}};
  if (c.chance) document["inner_points"] = c.chance->inner_points;
  return document;
}

SharePlot comparison_plot(const Comparison& c) {
  SharePlot plot;
  plot.title = "Similarity of two skeletons";
  plot.notes = {"A: " + side_text(c.a), "B: " + side_text(c.b)};
  plot.x_label = c.squared ? "squared distance r^2, mesh units squared" : "distance r, mesh units";
  plot.x_max = shown_radius(c, c.radii.back());
  plot.marked = shown_radius(c, c.radius);
  plot.marked_label = (c.squared ? "r^2 = " : "r = ") + base::rounded(plot.marked, 4);
  // A is drawn first and broader, so that both are seen where they coincide.
  plot.curves.push_back(plotted(c, c.curves.a_in_b, {"points of A within r of B", "#0b62a4", false, 4, {}}));
  plot.curves.push_back(
      plotted(c, c.curves.b_in_a, {"points of B within r of A", "#e07b1a", false, 1.7, {}}));
  if (c.chance) {
    plot.curves.push_back(
        plotted(c, c.chance->in_b, {"chance: inner points within r of B", "#7aa6c8", true, 2.6, {}}));
    plot.curves.push_back(
        plotted(c, c.chance->in_a, {"chance: inner points within r of A", "#e3a878", true, 1.5, {}}));
  }
  return plot;
}

}  // namespace affskel::client
