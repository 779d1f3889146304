#include "report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "targets.h"
#include "tools/report_text.h"

namespace affskel::bench {
namespace {

using tests::format;
using tests::Table;

const std::vector<std::string> kColumns{"row",
                                        "N",
                                        "R",
                                        "K",
                                        "prepare s",
                                        "trees s",
                                        "sweep s",
                                        "wall s",
                                        "peak MB",
                                        "sweep ns/(pt,dir)",
                                        "pt-dir/s",
                                        "tree ns/triangle",
                                        "trees/sort",
                                        "plain/pruned",
                                        "2 threads",
                                        "reference s",
                                        "reference/wall"};

std::string number(const std::optional<double>& value, const char* pattern = "%.2f") {
  if (!value) return "-";
  char text[64];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
  std::snprintf(text, sizeof text, pattern, *value);
#pragma GCC diagnostic pop
  return text;
}

std::string directions(const RowResult& r) {
  const std::string used = std::to_string(r.directions);
  return r.directions == r.directions_all ? used : used + " of " + std::to_string(r.directions_all);
}

std::vector<std::string> speed_row(const RowResult& r) {
  if (!r.error.empty()) {
    std::vector<std::string> cells{r.name, "failed: " + r.error};
    cells.resize(kColumns.size());
    return cells;
  }
  return {r.name,
          std::to_string(r.triangles),
          std::to_string(r.points),
          directions(r),
          format("%.3f", r.prepare_s),
          format("%.3f", r.trees_s),
          format("%.3f", r.sweep_s),
          format("%.3f", r.wall_s),
          format("%.0f", r.peak_mb),
          format("%.3f", r.sweep_ns()),
          format("%.2e", r.rate()),
          format("%.0f", r.tree_ns_per_triangle()),
          number(r.trees_per_sort()),
          number(r.plain_per_pruned(), "%.1f"),
          number(r.two_thread_speed_up()),
          r.reference ? format("%.4g (%llu timed)", r.reference->seconds,
                               static_cast<unsigned long long>(r.reference->triangles_timed))
                      : "-",
          number(r.reference_per_wall(), "%.0f")};
}

std::string table(std::span<const RowResult> results, Section section) {
  Table rows{kColumns, {}};
  for (const RowResult& r : results) {
    if (r.section == section) rows.rows.push_back(speed_row(r));
  }
  return rows.rows.empty() ? "" : rows.markdown();
}

std::string section(const char* title, const std::string& body) {
  return body.empty() ? body : std::string("\n## ") + title + "\n\n" + body;
}

std::string growth_text(std::span<const RowResult> results) {
  const Growth growth = growth_of(results);
  if (!growth.wall_over_n && !growth.wall_over_r) return "";
  return table(results, Section::kGrowthN) + "\nWall time grows as N^" + number(growth.wall_over_n) +
         " over these bodies, R and K fixed.\n\n" + table(results, Section::kGrowthR) +
         "\nWall time grows as R^" + number(growth.wall_over_r) +
         " over these lattices, N and K fixed; the sweep alone as R^" + number(growth.sweep_over_r) +
         ".\n\nExponents by least squares of the logarithms.\n";
}

std::string target_text(std::span<const RowResult> results) {
  Table table{{"target", "bound", "measured", "met", "row"}, {}};
  for (const Target& t : targets_of(results)) {
    table.rows.push_back({t.what, (t.at_least ? ">= " : "<= ") + format("%g", t.bound),
                          number(t.measured, "%.3g"),
                          !t.measured ? "not measured"
                          : t.met()   ? "yes"
                                      : "no",
                          t.row});
  }
  return table.markdown();
}

std::string machine_text(const Machine& m) {
  return m.processor + ", " + std::to_string(m.processors) + " processors, " + m.memory + "; " + m.compiler +
         ", " + m.build + "; core version " + m.core_version + "; " + m.date + "; load " +
         format("%.1f", m.load_at_start) + " at the start, " + format("%.1f", m.load_at_finish) +
         " at the end.\n";
}

std::string sources_text(std::span<const RowResult> results) {
  std::string text, seen;
  for (const RowResult& r : results) {
    const std::string mesh = r.name.substr(0, r.name.find(','));
    if (seen.find(mesh + ";") != std::string::npos) continue;
    seen += mesh + ";";
    text += (text.empty() ? "" : ", ") + mesh + " (" + r.source + ")";
  }
  return "Meshes: " + text + ".\n";
}

constexpr const char* kNotes = R"(
N triangles, R sample points, K directions worked on, in the service's order; "k of n" is a stretch of that
order, which has directions from all over the set.  prepare: from the OFF text to the first direction.  Wall:
the whole job on one thread.  Jobs under 2 s are repeated up to 20 times and the fastest run counts.  Every
row runs in a process of its own, and peak MB is its ru_maxrss after the first run, before any yardstick.
dT 200: bodies scaled to 18,000 units, the setting of the published experiments.

Yardsticks are measured in the row's process after its job, the best of three, and ratios are of processor
times.  trees/sort: all join trees over K std::sorts of N/2 (height, index) pairs, heights given.
plain/pruned: the sweep that computes every chord, on a sample of directions, over the pruned one.  2 threads:
wall time on one thread over that on two, jobs of 5 s or more.  reference: the published program as the
literature describes it, written anew and run on this machine with dT = dD, timed on triangles spread over the
mesh and scaled to all of them.
)";

}  // namespace

std::string summary(const RowResult& r) {
  if (!r.error.empty()) return r.name + ": failed: " + r.error;
  return r.name + ": " +
         format("wall %.3f s, trees %.3f s, sweep %.3f s, %.3f ns/(pt,dir), %.0f MB", r.wall_s, r.trees_s,
                r.sweep_s, r.sweep_ns(), r.peak_mb) +
         ", trees/sort " + number(r.trees_per_sort()) + ", plain/pruned " +
         number(r.plain_per_pruned(), "%.1f") + ", 2 threads " + number(r.two_thread_speed_up());
}

std::string markdown(const Machine& machine, std::span<const RowResult> results) {
  return "# Benchmark\n\n" + machine_text(machine) + "\n" + sources_text(results) +
         section("Speed", table(results, Section::kTable)) + kNotes +
         section("Growth", growth_text(results)) + section("Memory", table(results, Section::kMemory)) +
         section("Targets", target_text(results));
}

nlohmann::json report_json(const Machine& machine, std::span<const RowResult> results) {
  return {{"machine", machine},
          {"rows", std::vector<RowResult>(results.begin(), results.end())},
          {"growth", growth_of(results)},
          {"targets", targets_of(results)}};
}

}  // namespace affskel::bench
