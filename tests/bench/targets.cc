#include "targets.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "growth.h"

namespace affskel::bench {
namespace {

using Choice = std::function<bool(const RowResult&)>;
using Figure = std::function<std::optional<double>(const RowResult&)>;

bool is_body(const RowResult& r) {
  return r.name.starts_with("body");
}
bool is_ball_5120(const RowResult& r) {
  return r.name.starts_with("ball 5120,");
}
bool in_table(const RowResult& r) {
  return r.section == Section::kTable;
}

// The rows that the targets for the sweep speak of.
bool is_sweep_row(const RowResult& r) {
  return in_table(r) && r.points >= 90000 && (r.name.starts_with("body 5000,") || is_ball_5120(r));
}
bool is_tree_row(const RowResult& r) {
  return in_table(r) && ((is_body(r) && r.triangles >= 1000) || is_ball_5120(r));
}

Target worst(std::span<const RowResult> results, Target target, const Choice& choice, const Figure& figure) {
  for (const RowResult& r : results) {
    if (!r.error.empty() || !choice(r)) continue;
    const std::optional<double> value = figure(r);
    if (!value) continue;
    const bool worse =
        !target.measured || (target.at_least ? *value < *target.measured : *value > *target.measured);
    if (!worse) continue;
    target.measured = value;
    target.row = r.name;
  }
  return target;
}

Target at_most(const char* what, double bound) {
  return {what, bound, false, std::nullopt, ""};
}
Target at_least(const char* what, double bound) {
  return {what, bound, true, std::nullopt, ""};
}

std::optional<double> exponent(std::span<const RowResult> results, Section section,
                               const std::function<std::pair<double, double>(const RowResult&)>& point) {
  std::vector<std::pair<double, double>> points;
  for (const RowResult& r : results) {
    if (r.section == section && r.error.empty()) points.push_back(point(r));
  }
  return growth_exponent(points);
}

void add_ratios(std::span<const RowResult> results, std::vector<Target>& targets) {
  targets.push_back(worst(
      results, at_least("reference program / wall, body 292 at spacing 200", 3000),
      [](const RowResult& r) { return r.name == "body 292, dT 200"; },
      [](const RowResult& r) { return r.reference_per_wall(); }));
  targets.push_back(worst(results, at_most("trees / sort units, bodies from 1000 on and ball 5120", 2.5),
                          is_tree_row, [](const RowResult& r) { return r.trees_per_sort(); }));
  targets.push_back(worst(results,
                          at_most("sweep, ns per (point, direction), body 5000 and ball 5120, R >= 1e5", 1.2),
                          is_sweep_row, [](const RowResult& r) { return std::optional(r.sweep_ns()); }));
  targets.push_back(worst(results, at_least("plain sweep / pruned sweep, the same rows", 15), is_sweep_row,
                          [](const RowResult& r) { return r.plain_per_pruned(); }));
  targets.push_back(worst(
      results, at_least("speed-up by a second thread, jobs of 5 s or more", 1.85),
      [](const RowResult&) { return true; }, [](const RowResult& r) { return r.two_thread_speed_up(); }));
}

void add_growth_targets(std::span<const RowResult> results, std::vector<Target>& targets) {
  const Growth growth = growth_of(results);
  targets.push_back(at_most("exponent of wall time over N, bodies 1000 to 107024", 1.4));
  targets.back().measured = growth.wall_over_n;
  targets.push_back(at_most("exponent of wall time over R, 1e5 to 1e7 points", 0.8));
  targets.back().measured = growth.wall_over_r;
}

void add_memory(std::span<const RowResult> results, std::vector<Target>& targets) {
  targets.push_back(worst(
      results, at_most("peak memory / (64 bytes per point + 500 per triangle + 60 MB)", 1),
      [](const RowResult&) { return true; },
      [](const RowResult& r) { return std::optional(r.peak_mb / r.memory_allowed_mb()); }));
  targets.push_back(worst(
      results, at_most("peak MB, ball of 1,000,000 triangles, 1e6 points, sphere:200", 1536),
      [](const RowResult& r) { return r.section == Section::kMemory; },
      [](const RowResult& r) { return std::optional(r.peak_mb); }));
}

}  // namespace

Growth growth_of(std::span<const RowResult> results) {
  const auto wall_over_n = [](const RowResult& r) {
    return std::pair(static_cast<double>(r.triangles), r.wall_s);
  };
  const auto wall_over_r = [](const RowResult& r) {
    return std::pair(static_cast<double>(r.points), r.wall_s);
  };
  const auto sweep_over_r = [](const RowResult& r) {
    return std::pair(static_cast<double>(r.points), r.sweep_s);
  };
  return {exponent(results, Section::kGrowthN, wall_over_n),
          exponent(results, Section::kGrowthR, wall_over_r),
          exponent(results, Section::kGrowthR, sweep_over_r)};
}

std::vector<Target> targets_of(std::span<const RowResult> results) {
  std::vector<Target> targets;
  add_ratios(results, targets);
  add_growth_targets(results, targets);
  add_memory(results, targets);
  targets.push_back(worst(
      results, at_most("seconds on two threads, body 107024, all directions, 1e5 points", 600),
      [](const RowResult& r) { return r.triangles == 107024 && r.directions == r.directions_all; },
      [](const RowResult& r) { return r.wall_two_threads_s; }));
  return targets;
}

void to_json(nlohmann::json& json, const Target& t) {
  json = {
      {"what", t.what}, {"bound", t.bound}, {"kind", t.at_least ? "at least" : "at most"}, {"row", t.row}};
  json["measured"] = t.measured ? nlohmann::json(*t.measured) : nlohmann::json();
  json["met"] = t.measured ? nlohmann::json(t.met()) : nlohmann::json();
}

void to_json(nlohmann::json& json, const Growth& growth) {
  const auto put = [&](const char* key, const std::optional<double>& value) {
    json[key] = value ? nlohmann::json(*value) : nlohmann::json();
  };
  put("wall_over_n", growth.wall_over_n);
  put("wall_over_r", growth.wall_over_r);
  put("sweep_over_r", growth.sweep_over_r);
}

}  // namespace affskel::bench
