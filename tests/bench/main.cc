// affskel_bench: one table of what a job costs, with yardsticks from the same run.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "limit.h"
#include "machine.h"
#include "measure.h"
#include "mesh_store.h"
#include "ratio_check.h"
#include "report.h"

namespace {

using namespace affskel::bench;

struct Options {
  bool quick = false, full = false, limit = false;
  double memory_gb = 0;
  std::string data_dir, json_file, markdown_file, check_file, expect_file, only;
};

// Loads from other processes can spoil a ratio, never better it: a row that fails is measured again.
constexpr int kCheckAttempts = 4;
constexpr double kCheckFactor = 2;

// Processor seconds for the published program, per row.
constexpr double kReference = 20;
constexpr double kQuickReference = 1;

void write_file(const std::string& path, const std::string& text) {
  if (path.empty()) return;
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

nlohmann::json read_json(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be opened for reading");
  try {
    return nlohmann::json::parse(file);
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

std::vector<RowSpec> chosen_rows(const Options& options) {
  const RowSet set = options.quick ? RowSet::kQuick : options.full ? RowSet::kFull : RowSet::kDefault;
  std::vector<RowSpec> rows = rows_of(set);
  std::erase_if(rows,
                [&](const RowSpec& row) { return row_name(row).find(options.only) == std::string::npos; });
  if (rows.empty()) throw std::runtime_error("--only " + options.only + ": no row has this in its name");
  return rows;
}

RowResult measure_row(const RowSpec& row, MeshStore& meshes, const MeasureOptions& options) {
  RowResult result = measure(row, meshes.file(row.mesh), options);
  result.source = meshes.source(row.mesh);
  std::fprintf(stderr, "%s\n", summary(result).c_str());
  return result;
}

bool failed(const std::vector<RatioFailure>& failures, const RowResult& result) {
  return std::any_of(failures.begin(), failures.end(),
                     [&](const RatioFailure& f) { return f.row == result.name; });
}

int check(const Options& options, const std::vector<RowSpec>& rows, MeshStore& meshes,
          std::vector<RowResult>& results) {
  const nlohmann::json expected = read_json(options.check_file);
  std::vector<RatioFailure> failures = check_ratios(expected, results);
  for (int attempt = 1; attempt < kCheckAttempts && !failures.empty(); ++attempt) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!failed(failures, results[i])) continue;
      std::fprintf(stderr, "again: ");
      results[i] = better_of(results[i], measure_row(rows[i], meshes, {.two_threads = false}));
    }
    failures = check_ratios(expected, results);
  }
  for (const RatioFailure& failure : failures) {
    std::fprintf(stderr, "%s: %s\n", options.check_file.c_str(), failure.message.c_str());
  }
  return failures.empty() ? 0 : 1;
}

int run(const Options& options) {
  Machine machine = this_machine();
  const std::vector<RowSpec> rows = chosen_rows(options);
  MeshStore meshes(options.data_dir);
  std::vector<RowResult> results;
  MeasureOptions how;
  how.two_threads = !options.quick;
  if (options.check_file.empty()) how.reference_s = options.quick ? kQuickReference : kReference;
  for (const RowSpec& row : rows) results.push_back(measure_row(row, meshes, how));
  const int status = options.check_file.empty() ? 0 : check(options, rows, meshes, results);
  machine.load_at_finish = load_average();
  const std::string page = markdown(machine, results);
  std::fputs(page.c_str(), stdout);
  write_file(options.markdown_file, page);
  write_file(options.json_file, report_json(machine, results).dump(2) + "\n");
  const nlohmann::json ratios = ratios_of(results, kCheckFactor);
  if (!options.expect_file.empty()) write_file(options.expect_file, ratios.dump(2) + "\n");
  const bool broken =
      std::any_of(results.begin(), results.end(), [](const RowResult& r) { return !r.error.empty(); });
  return broken ? 1 : status;
}

int run_limit(const Options& options) {
  LimitOptions limit;
  limit.memory = options.memory_gb > 0 ? static_cast<std::uint64_t>(options.memory_gb * (1 << 30))
                                       : available_memory() / 10 * 8;
  limit.done = [](const RowResult& result) { std::fprintf(stderr, "%s\n", summary(result).c_str()); };
  MeshStore meshes("");
  const std::string page = limits_markdown(find_limits(meshes, limit), limit);
  std::fputs(page.c_str(), stdout);
  write_file(options.markdown_file, page);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Measures what computing erosion fields costs: time, memory, growth, and ratios to yardsticks.");
  auto* quick = app.add_flag("--quick", options.quick, "the smallest rows only, in under a minute");
  app.add_flag("--full", options.full, "also the largest body with all its directions, and the large ball")
      ->excludes(quick);
  app.add_flag("--limit", options.limit,
               "find the largest jobs that run: doubles triangles, then points, until one fails")
      ->excludes(quick);
  app.add_option("--memory-gb", options.memory_gb,
                 "with --limit: memory a job may use; else 80 % of what is available");
  app.add_option("--data", options.data_dir,
                 "directory with mh_man_292.off ... mh_man_apose_107024.off, used for the bodies")
      ->check(CLI::ExistingDirectory);
  app.add_option("--only", options.only, "only rows whose name contains this");
  app.add_option("--json", options.json_file, "also write the report as JSON");
  app.add_option("--markdown", options.markdown_file,
                 "also write the report, which goes to stdout, to a file");
  app.add_option("--check", options.check_file,
                 "compare the ratios with those of this file; exit 1 when one is off")
      ->check(CLI::ExistingFile);
  app.add_option("--write-expected", options.expect_file,
                 "write this run's ratios in the form that --check reads");
  app.footer(
      "Examples:\n"
      "  affskel_bench --full --json bench.json > bench.md\n"
      "  affskel_bench --only 'body 5000' --data DIR\n"
      "  affskel_bench --limit --memory-gb 8");
  CLI11_PARSE(app, argc, argv);
  try {
    return options.limit ? run_limit(options) : run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "affskel_bench: %s\n", error.what());
    return 2;
  }
}
