// affskel_experiments: the published experimental chapter, run again.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <thread>

#include "core/base/stopwatch.h"
#include "core/base/version.h"
#include "experiments.h"
#include "report.h"

namespace {

using namespace affskel::experiments;

struct Experiment {
  const char* name;
  void (*run)(const Setting&, Report&);
};

constexpr Experiment kExperiments[] = {
    {"torus", torus_experiment},
    {"ellipsoid", ellipsoid_experiment},
    {"revolution", revolution_experiment},
    {"bodies", body_experiment},
    {"threshold", threshold_experiment},
    {"noise", noise_experiment},
    {"affine", affine_experiment},
    {"planes", plane_experiment},
    {"barrier", barrier_experiment},
    {"steadiness", steadiness_experiment},
    {"reach", reach_experiment},
    {"looks", looks_experiment},
    {"lattices", lattice_experiment},
    {"limbs", limbs_experiment},
    {"graphs", graph_experiment},
    {"tessellations", tessellation_experiment},
    {"confirmations", confirmation_experiment},
    {"misses", miss_experiment},
    {"medial", medial_experiment},
    {"growth", growth_experiment},
};

std::string heading(const Setting& setting, double seconds) {
  std::string text =
      "# The published experiments, run again\n\n"
      "V. Zografos, *On the affine skeleton of 3D models of the human body*, 2003, chapter 6, with the exact "
      "erosion "
      "levels that this project computes (the limit of vanishing plane steps dD of the published method). "
      "Lengths are in mesh units, which the published work calls pixels; dT is the spacing of the sample "
      "points. Published times were taken on a dual Celeron at 550 MHz; ours are of this machine as it was, "
      "on " +
      std::to_string(setting.threads) + (setting.threads == 1 ? " thread" : " threads") +
      ", and include everything from the mesh to the erosion field. Made by `affskel_experiments` in " +
      duration(seconds) + ", core version " + affskel::core::kCoreVersion + ".\n";
  if (setting.quick) {
    text +=
        "\n**A quick run: coarse lattices and few triangles. The figures show that everything works, nothing "
        "more.**\n";
  }
  return text;
}

int run(const Setting& setting, const std::string& directory, const std::string& only) {
  const affskel::core::Stopwatch all;
  Report report(directory);
  for (const Experiment& experiment : kExperiments) {
    if (!only.empty() && only != experiment.name) continue;
    const affskel::core::Stopwatch own;
    experiment.run(setting, report);
    std::fprintf(stderr, "%-10s %6.2f s\n", experiment.name, own.seconds());
  }
  report.write(heading(setting, all.seconds()));
  for (const Check& check : report.checks()) {
    if (check.holds()) continue;
    std::fprintf(stderr, "%s: %g is not in %g .. %g\n", check.what.c_str(), check.value, check.low,
                 check.high);
  }
  std::fprintf(stderr, "%s\n", (directory + "/REPORT.md").c_str());
  return report.all_hold() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Setting setting;
  setting.threads = std::max(1U, std::thread::hardware_concurrency());
  std::string directory = "experiments", only;
  CLI::App app("Runs the published experiments again and writes them up: DIR/REPORT.md and its pictures.");
  app.add_flag("--quick", setting.quick, "small sizes, in seconds");
  app.add_option("--out", directory, "the directory to write to")->capture_default_str();
  app.add_option("--threads", setting.threads, "threads for the erosion")->check(CLI::Range(1U, 1024U));
  std::set<std::string> names;
  for (const Experiment& experiment : kExperiments) names.insert(experiment.name);
  app.add_option("--only", only, "one experiment alone")->check(CLI::IsMember(names));
  app.add_option("--seeds", setting.seeds, "of steadiness, noise and graphs: noises of each level")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  app.add_option(
         "--mesh", setting.meshes,
         "of steadiness, noise, reach, looks, lattices and limbs: files in the place of solids of our own")
      ->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(setting, directory, only);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "affskel_experiments: %s\n", error.what());
    return 2;
  }
}
