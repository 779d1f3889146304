#include "ratio_check.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace affskel::bench {
namespace {

std::string too_bad(const std::string& row, const char* ratio, double measured, const char* limit_kind,
                    double limit, double expected) {
  char text[256];
  std::snprintf(text, sizeof text, ": %s is %.3g, should be %s %.3g (expected %.3g)", ratio, measured,
                limit_kind, limit, expected);
  return row + text;
}

void check_row(const nlohmann::json& expected, double factor, const RowResult& r,
               std::vector<RatioFailure>& failures) {
  if (!r.error.empty()) {
    failures.push_back({r.name, r.name + ": " + r.error});
    return;
  }
  const double trees = expected.at("trees_per_sort").get<double>();
  const double pruning = expected.at("plain_per_pruned").get<double>();
  const double measured_trees = r.trees_per_sort().value_or(HUGE_VAL);
  const double measured_pruning = r.plain_per_pruned().value_or(0);
  // Written so that a ratio that is no number fails.
  if (!(measured_trees <= factor * trees)) {
    failures.push_back(
        {r.name, too_bad(r.name, "trees/sort", measured_trees, "at most", factor * trees, trees)});
  }
  if (!(measured_pruning >= pruning / factor)) {
    failures.push_back(
        {r.name, too_bad(r.name, "plain/pruned", measured_pruning, "at least", pruning / factor, pruning)});
  }
}

const RowResult* find(std::span<const RowResult> results, const std::string& name) {
  for (const RowResult& r : results) {
    if (r.name == name) return &r;
  }
  return nullptr;
}

std::vector<RatioFailure> compare(const nlohmann::json& expected, std::span<const RowResult> results) {
  std::vector<RatioFailure> failures;
  const double factor = expected.at("factor").get<double>();
  const nlohmann::json& rows = expected.at("rows");
  for (const auto& [name, row] : rows.items()) {
    const RowResult* result = find(results, name);
    if (result) {
      check_row(row, factor, *result, failures);
    } else {
      failures.push_back({name, name + ": expected, but not measured"});
    }
  }
  for (const RowResult& r : results) {
    if (!rows.contains(r.name))
      failures.push_back({r.name, r.name + ": measured, but nothing is expected of it"});
  }
  return failures;
}

double two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return std::stod(text);
}

}  // namespace

std::vector<RatioFailure> check_ratios(const nlohmann::json& expected, std::span<const RowResult> results) {
  try {
    return compare(expected, results);
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("expected ratios: ") + error.what());
  }
}

nlohmann::json ratios_of(std::span<const RowResult> results, double factor) {
  nlohmann::json rows = nlohmann::json::object();
  for (const RowResult& r : results) {
    if (!r.error.empty() || !r.trees_per_sort() || !r.plain_per_pruned()) continue;
    rows[r.name] = {{"trees_per_sort", two_digits(*r.trees_per_sort())},
                    {"plain_per_pruned", two_digits(*r.plain_per_pruned())}};
  }
  return {{"factor", factor}, {"rows", rows}};
}

}  // namespace affskel::bench
