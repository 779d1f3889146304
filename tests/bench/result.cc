#include "result.h"

#include <nlohmann/json.hpp>

namespace affskel::bench {
namespace {

using nlohmann::json;

json or_null(const std::optional<double>& value) {
  return value ? json(*value) : json();
}

std::optional<double> number_or_none(const json& value) {
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

// Applies `visit(key, field)` to every stored field that JSON takes as it is.
template <class Result, class Visit>
void visit_fields(Result& r, const Visit& visit) {
  visit("name", r.name);
  visit("mesh_source", r.source);
  visit("error", r.error);
  visit("triangles", r.triangles);
  visit("points", r.points);
  visit("directions", r.directions);
  visit("directions_all", r.directions_all);
  visit("spacing", r.spacing);
  visit("v0", r.v0);
  visit("prepare_s", r.prepare_s);
  visit("trees_s", r.trees_s);
  visit("sweep_s", r.sweep_s);
  visit("wall_s", r.wall_s);
  visit("trees_cpu_s", r.trees_cpu_s);
  visit("sweep_cpu_s", r.sweep_cpu_s);
  visit("repeats", r.repeats);
  visit("peak_mb", r.peak_mb);
  visit("chords_evaluated", r.chords_evaluated);
  visit("chords_tested", r.chords_tested);
  visit("sort_directions", r.sort_directions);
  visit("plain_directions", r.plain_directions);
}

}  // namespace

std::optional<double> RowResult::trees_per_sort() const {
  if (!sort_unit_s) return std::nullopt;
  return trees_cpu_s / (static_cast<double>(directions) * *sort_unit_s);
}

std::optional<double> RowResult::plain_per_pruned() const {
  if (!plain_ns) return std::nullopt;
  return *plain_ns * pairs() / (1e9 * sweep_cpu_s);
}

std::optional<double> RowResult::two_thread_speed_up() const {
  if (!wall_two_threads_s) return std::nullopt;
  return wall_s / *wall_two_threads_s;
}

std::optional<double> RowResult::reference_per_wall() const {
  if (!reference) return std::nullopt;
  return reference->seconds / wall_s;
}

double RowResult::memory_allowed_mb() const {
  return (64 * static_cast<double>(points) + 500 * static_cast<double>(triangles)) / (1 << 20) + 60;
}

void to_json(json& json, const RowResult& r) {
  json = nlohmann::json::object();
  visit_fields(r, [&](const char* key, const auto& field) { json[key] = field; });
  json["section"] = static_cast<int>(r.section);
  json["sort_unit_s"] = or_null(r.sort_unit_s);
  json["plain_ns"] = or_null(r.plain_ns);
  json["wall_two_threads_s"] = or_null(r.wall_two_threads_s);
  json["reference"] = nullptr;
  if (r.reference) {
    json["reference"] = {{"seconds", r.reference->seconds},
                         {"triangles_timed", r.reference->triangles_timed}};
  }
  if (!r.error.empty()) return;
  json["sweep_ns"] = r.sweep_ns();
  json["point_directions_per_s"] = r.rate();
  json["tree_ns_per_triangle"] = r.tree_ns_per_triangle();
  json["trees_per_sort"] = or_null(r.trees_per_sort());
  json["plain_per_pruned"] = or_null(r.plain_per_pruned());
  json["two_thread_speed_up"] = or_null(r.two_thread_speed_up());
  json["reference_per_wall"] = or_null(r.reference_per_wall());
  json["memory_allowed_mb"] = r.memory_allowed_mb();
}

void from_json(const json& json, RowResult& r) {
  visit_fields(r, [&](const char* key, auto& field) { json.at(key).get_to(field); });
  r.section = static_cast<Section>(json.at("section").get<int>());
  r.sort_unit_s = number_or_none(json.at("sort_unit_s"));
  r.plain_ns = number_or_none(json.at("plain_ns"));
  r.wall_two_threads_s = number_or_none(json.at("wall_two_threads_s"));
  const nlohmann::json& reference = json.at("reference");
  r.reference.reset();
  if (!reference.is_null()) {
    r.reference = ReferenceTime{reference.at("seconds").get<double>(),
                                reference.at("triangles_timed").get<std::uint64_t>()};
  }
}

}  // namespace affskel::bench
