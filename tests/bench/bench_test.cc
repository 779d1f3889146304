#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <vector>

#include "core/text/off_file.h"
#include "forked.h"
#include "growth.h"
#include "job.h"
#include "limit.h"
#include "measure.h"
#include "mesh_store.h"
#include "ratio_check.h"
#include "reference_time.h"
#include "report.h"
#include "result.h"
#include "rows.h"
#include "targets.h"
#include "yardsticks.h"

namespace affskel::bench {
namespace {

// A measured row with round figures: trees/sort 2, plain/pruned 10.
RowResult round_result() {
  RowResult r;
  r.name = "body 5000, 1e5 points";
  r.source = "generated";
  r.triangles = 5000;
  r.points = 100000;
  r.directions = r.directions_all = 5000;
  r.trees_s = r.trees_cpu_s = 2;
  r.sweep_s = r.sweep_cpu_s = 0.5;
  r.prepare_s = 0.5;
  r.wall_s = 3;
  r.peak_mb = 40;
  r.sort_unit_s = 2e-4;
  r.plain_ns = 10;
  return r;
}

RowSpec small_row() {
  RowSpec row;
  row.mesh = {Shape::kTorus, 256};
  row.points = 500;
  return row;
}

TEST(Growth, FindsTheExponentOfAPowerLaw) {
  std::vector<std::pair<double, double>> points;
  for (const double x : {1e3, 5e3, 2e4, 1e5}) points.emplace_back(x, 3e-7 * std::pow(x, 1.37));
  EXPECT_NEAR(growth_exponent(points).value(), 1.37, 1e-12);
}

TEST(Growth, NeedsTwoAbscissae) {
  EXPECT_FALSE(growth_exponent({}).has_value());
  const std::vector<std::pair<double, double>> same{{10, 1}, {10, 2}};
  EXPECT_FALSE(growth_exponent(same).has_value());
}

TEST(Rows, NamesAreUniqueInEverySet) {
  for (const RowSet set : {RowSet::kQuick, RowSet::kDefault, RowSet::kFull}) {
    std::set<std::string> names;
    for (const RowSpec& row : rows_of(set)) EXPECT_TRUE(names.insert(row_name(row)).second) << row_name(row);
  }
}

TEST(Rows, NamesSayMeshAndLattice) {
  RowSpec row = small_row();
  EXPECT_EQ(row_name(row), "torus 256, 5e2 points");
  row.points = 0;
  row.spacing = 200;
  EXPECT_EQ(row_name(row), "torus 256, dT 200");
}

TEST(Forked, ReturnsTheResultOfTheWork) {
  const std::string large(1 << 20, 'x');  // more than a pipe holds
  EXPECT_EQ(run_forked([&] { return large; }), large);
}

TEST(Forked, PassesErrorsOn) {
  try {
    run_forked([]() -> std::string { throw std::runtime_error("the cause"); });
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the cause");
  }
}

TEST(Forked, TellsOfASignal) {
  try {
    run_forked([]() -> std::string {
      std::raise(SIGKILL);
      return "";
    });
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "killed by signal 9");
  }
}

TEST(Forked, KeepsToItsMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the limit is one of address space, of which sanitizers reserve terabytes; runs in a build "
                  "without them (presets release, dev, debug)";
#endif
  const auto work = [] { return std::to_string(std::vector<char>(std::size_t{1} << 30, 'x').size()); };
  EXPECT_THROW(run_forked(work, std::uint64_t{1} << 29), std::runtime_error);
}

TEST(Limit, StopsAtTheTimeAllowed) {
  MeshStore store("");
  LimitOptions options;
  options.first_triangles = 320;
  options.first_points = 100000;
  options.longest_s = 0;
  const std::vector<LimitSearch> searches = find_limits(store, options);
  ASSERT_EQ(searches.size(), 2U);
  for (const LimitSearch& search : searches) {
    EXPECT_EQ(search.results.size(), 1U);
    EXPECT_EQ(search.reason, "the time allowed for one job");
  }
  EXPECT_EQ(searches[0].results[0].triangles, 320U);
  EXPECT_NE(limits_markdown(searches, options).find("| ball 320, 1e5 points, sphere:20 | 320 |"),
            std::string::npos);
  EXPECT_GT(available_memory(), 0U);
}

TEST(Reference, IsTimedOnASampleAndScaledForSmallRowsWithASpacing) {
  MeshStore store("");
  RowSpec row;
  row.mesh = {Shape::kTorus, 256};
  row.spacing = 1000;
  const std::optional<ReferenceTime> time = run_reference(row, store.file(row.mesh), 1e-9);
  ASSERT_TRUE(time.has_value());
  EXPECT_EQ(time->triangles_timed, 8U);
  EXPECT_GT(time->seconds, 0);
  EXPECT_FALSE(run_reference(small_row(), store.file(row.mesh), 1).has_value());
}

TEST(Result, DerivedFiguresFollowTheirDefinitions) {
  const RowResult r = round_result();
  EXPECT_DOUBLE_EQ(r.sweep_ns(), 1.0);
  EXPECT_DOUBLE_EQ(r.rate(), 5e8 / 3);
  EXPECT_DOUBLE_EQ(r.tree_ns_per_triangle(), 80.0);
  EXPECT_DOUBLE_EQ(r.trees_per_sort().value(), 2.0);
  EXPECT_DOUBLE_EQ(r.plain_per_pruned().value(), 10.0);
  EXPECT_FALSE(r.two_thread_speed_up().has_value());
  EXPECT_DOUBLE_EQ(r.memory_allowed_mb(), 60 + (6.4e6 + 2.5e6) / (1 << 20));
}

TEST(Result, RatiosAreOfProcessorTime) {
  RowResult r = round_result();
  r.trees_cpu_s = 1;  // half of the wall time went to other processes
  r.sweep_cpu_s = 0.25;
  EXPECT_DOUBLE_EQ(r.trees_per_sort().value(), 1.0);
  EXPECT_DOUBLE_EQ(r.plain_per_pruned().value(), 20.0);
}

TEST(Result, SurvivesJson) {
  RowResult r = round_result();
  r.section = Section::kGrowthR;
  r.reference = ReferenceTime{1234.5, 17};
  const RowResult back = nlohmann::json::parse(nlohmann::json(r).dump()).get<RowResult>();
  EXPECT_EQ(nlohmann::json(back), nlohmann::json(r));
  EXPECT_EQ(back.reference->triangles_timed, 17U);
  EXPECT_EQ(back.section, Section::kGrowthR);
  EXPECT_FALSE(back.wall_two_threads_s.has_value());
}

TEST(RatioCheck, MeetsItsOwnExpectations) {
  const std::vector<RowResult> results{round_result()};
  EXPECT_TRUE(check_ratios(ratios_of(results, 1.5), results).empty());
}

TEST(RatioCheck, FailsOnlyBeyondTheFactorAndOnlyForTheWorse) {
  const std::vector<RowResult> expected{round_result()};
  const nlohmann::json stored = ratios_of(expected, 2);
  RowResult r = round_result();
  r.trees_cpu_s *= 1.9;
  EXPECT_TRUE(check_ratios(stored, std::vector{r}).empty());
  r.trees_cpu_s *= 1.1;
  ASSERT_EQ(check_ratios(stored, std::vector{r}).size(), 1U);
  EXPECT_NE(check_ratios(stored, std::vector{r})[0].message.find("trees/sort"), std::string::npos);
  r = round_result();
  r.sweep_cpu_s *= 2.1;
  ASSERT_EQ(check_ratios(stored, std::vector{r}).size(), 1U);
  EXPECT_NE(check_ratios(stored, std::vector{r})[0].message.find("plain/pruned"), std::string::npos);
  r.sweep_cpu_s = 0.01;
  r.trees_cpu_s = 0.01;
  EXPECT_TRUE(check_ratios(stored, std::vector{r}).empty());
}

TEST(RatioCheck, MissesNothing) {
  const std::vector<RowResult> results{round_result()};
  const nlohmann::json stored = ratios_of(results, 2);
  EXPECT_EQ(check_ratios(stored, {}).size(), 1U);
  RowResult other = round_result();
  other.name = "ball 5120, 1e5 points";
  EXPECT_EQ(check_ratios(stored, std::vector{round_result(), other}).size(), 1U);
  RowResult broken = round_result();
  broken.error = "killed by signal 9";
  EXPECT_EQ(check_ratios(stored, std::vector{broken}).size(), 1U);
  EXPECT_THROW(check_ratios(nlohmann::json::array(), results), std::runtime_error);
}

TEST(RatioCheck, BetterOfKeepsTheBestOfEveryFigure) {
  RowResult a = round_result(), b = round_result();
  a.trees_cpu_s = 1;
  b.sort_unit_s = 1e-4;
  b.wall_s = 2.5;
  const RowResult best = better_of(a, b);
  EXPECT_DOUBLE_EQ(best.wall_s, 2.5);
  EXPECT_DOUBLE_EQ(best.trees_cpu_s, 1);
  EXPECT_DOUBLE_EQ(best.sort_unit_s.value(), 1e-4);
  b.error = "failed";
  EXPECT_DOUBLE_EQ(better_of(b, a).wall_s, 3);
}

TEST(Targets, TakeTheWorstRow) {
  RowResult slow = round_result();
  slow.name = "ball 5120, 1e5 points";
  slow.sweep_s = 0.7;
  const std::vector<RowResult> results{round_result(), slow};
  bool found = false;
  for (const Target& target : targets_of(results)) {
    if (target.what.find("ns per (point, direction)") == std::string::npos) continue;
    found = true;
    EXPECT_DOUBLE_EQ(target.measured.value(), 1.4);
    EXPECT_EQ(target.row, slow.name);
    EXPECT_FALSE(target.met());
  }
  EXPECT_TRUE(found);
}

TEST(Targets, NotMeasuredIsNotMet) {
  for (const Target& target : targets_of({})) {
    EXPECT_FALSE(target.measured.has_value()) << target.what;
    EXPECT_FALSE(target.met()) << target.what;
  }
}

TEST(MeshStore, GeneratesAndCleansUp) {
  std::string path;
  {
    MeshStore store("");
    path = store.file({Shape::kBall, 320});
    EXPECT_EQ(store.file({Shape::kBall, 320}), path);
    EXPECT_EQ(store.source({Shape::kBall, 320}), "generated");
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(core::read_off(text).mesh.triangles.size(), 320U);
  }
  EXPECT_FALSE(std::ifstream(path).good());
}

TEST(MeshStore, PrefersRealBodies) {
  MeshStore generated("");
  const std::filesystem::path directory =
      std::filesystem::path(generated.file({Shape::kBall, 20})).parent_path();
  const std::filesystem::path real = directory / "mh_man_apose_20.off";
  std::filesystem::copy_file(generated.file({Shape::kBall, 20}), real);
  MeshStore store(directory.string());
  EXPECT_EQ(store.file({Shape::kBody, 20}), real.string());
  EXPECT_EQ(store.source({Shape::kBody, 20}), "mh_man_apose_20.off");
  EXPECT_EQ(store.source({Shape::kBody, 292}), "generated");
  EXPECT_TRUE(std::filesystem::exists(real));
}

TEST(Job, WorksOnAStretchOfDifferentDirections) {
  MeshStore store("");
  RowSpec row = small_row();
  row.max_directions = 100;
  const Job job(store.file(row.mesh), row, 1);
  EXPECT_EQ(job.directions().size(), 256U);
  EXPECT_EQ(std::set<std::uint32_t>(job.list().begin(), job.list().end()).size(), 100U);
}

TEST(Job, BatchesAddUpToTheRun) {
  MeshStore store("");
  const RowSpec row = small_row();
  Job job(store.file(row.mesh), row, 1);
  const std::vector<Batch> batches = job.run_in_batches(0, job.list().size());
  double trees = 0, sweep = 0;
  for (const Batch& b : batches) {
    trees += b.trees_s;
    sweep += b.sweep_s;
  }
  EXPECT_LE(batches.size(), 256U);
  EXPECT_NEAR(trees, job.cost().trees_s, 1e-9);
  EXPECT_NEAR(sweep, job.cost().sweep_s, 1e-9);
  EXPECT_GE(job.cost().counts.evaluated, job.lattice().points);
}

TEST(Job, TheFastestOfEveryBatchIsKeptAndFreedOfOtherPeoplesTime) {
  std::vector<Batch> best;
  keep_fastest(best, {{2, 2, 4, 4}, {3, 1, 8, 4}});
  EXPECT_DOUBLE_EQ(trees_cpu(best), 2 + 1.5);
  EXPECT_DOUBLE_EQ(sweep_cpu(best), 2 + 0.5);
  keep_fastest(best, {{9, 9, 18, 18}, {3, 1, 4, 4}});
  EXPECT_DOUBLE_EQ(trees_cpu(best), 2 + 3);
  EXPECT_DOUBLE_EQ(sweep_cpu(best), 2 + 1);
}

TEST(Job, BodiesAreScaledToTheirUnits) {
  MeshStore store("");
  RowSpec row;
  row.mesh = {Shape::kBody, 292};
  row.spacing = 900;
  EXPECT_NEAR(Job(store.file(row.mesh), row, 1).lattice().spacing, 900, 1);
}

TEST(Measure, FillsARow) {
  MeshStore store("");
  const RowSpec row = small_row();
  const RowResult r = measure(row, store.file(row.mesh), {});
  ASSERT_EQ(r.error, "");
  EXPECT_EQ(r.name, row_name(row));
  EXPECT_EQ(r.triangles, 256U);
  EXPECT_EQ(r.directions, 256U);
  EXPECT_EQ(r.sort_directions, 256U);
  EXPECT_NEAR(static_cast<double>(r.points), 500, 100);
  EXPECT_GT(r.trees_s, 0);
  EXPECT_GT(r.sweep_s, 0);
  EXPECT_GE(r.wall_s, r.prepare_s);
  EXPECT_GT(r.peak_mb, 1);
  EXPECT_GT(r.trees_per_sort().value(), 0);
  EXPECT_GT(r.plain_per_pruned().value(), 0);
}

TEST(Measure, TellsWhyARowFailed) {
  const RowResult r = measure(small_row(), "no such file.off", {});
  EXPECT_NE(r.error.find("no such file.off"), std::string::npos);
  EXPECT_NE(summary(r).find("failed"), std::string::npos);
}

TEST(Yardsticks, SortEveryDirectionOfASmallMesh) {
  MeshStore store("");
  const RowSpec row = small_row();
  const Job job(store.file(row.mesh), row, 1);
  const Yardstick sort = sort_unit(job.solid().mesh, job.directions(), job.list(), 1);
  EXPECT_EQ(sort.directions, 256U);
  EXPECT_GT(sort.seconds_per_direction, 0);
}

TEST(Report, HasARowForEveryResultAndSaysWhatFailed) {
  RowResult broken = round_result();
  broken.name = "body 20000, 1e5 points";
  broken.error = "killed by signal 9";
  const std::vector<RowResult> results{round_result(), broken};
  const std::string page = markdown(this_machine(), results);
  EXPECT_NE(page.find("| body 5000, 1e5 points | 5000 | 100000 | 5000 |"), std::string::npos);
  EXPECT_NE(page.find("| body 20000, 1e5 points | failed: killed by signal 9 |"), std::string::npos);
  EXPECT_EQ(report_json(this_machine(), results).at("rows").size(), 2U);
}

}  // namespace
}  // namespace affskel::bench
