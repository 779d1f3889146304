#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "compute.h"
#include "core/error.h"
#include "wire/version.h"

namespace {

// Exit codes of the command-line contract.
constexpr int kBadInput = 3;
constexpr int kLimit = 8;
constexpr int kInternal = 70;

int exit_code(const affskel::core::CoreError& error) {
  switch (error.code()) {
    case affskel::core::CoreError::Code::kBadInput:
      return kBadInput;
    case affskel::core::CoreError::Code::kLimit:
      return kLimit;
    default:
      return kInternal;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("affskel-worker computes erosion fields.");
  app.set_version_flag("--version", affskel::wire::kVersion);
  app.require_subcommand(1);
  affskel::worker::ComputeOptions options;
  CLI::App* compute = app.add_subcommand("compute", "prepare and erode in this process, without a server");
  compute->add_option("FILE", options.file, "OFF mesh")->required();
  compute->add_option("--spacing", options.spacing, "lattice spacing in mesh units");
  compute->add_option("--points", options.points, "aim at this many sample points")->capture_default_str();
  compute->add_option("--directions", options.directions, "direction set")->capture_default_str();
  compute->add_option("--threads", options.threads, "threads")->capture_default_str();
  compute->add_flag("!--no-prune", options.prune, "evaluate every point for every direction (a yardstick)");
  compute->add_option("-o", options.output, "write the field as CSV");
  CLI11_PARSE(app, argc, argv);
  try {
    affskel::worker::compute(options);
    return 0;
  } catch (const affskel::core::CoreError& error) {
    std::fprintf(stderr, "affskel-worker: %s: %s\n", options.file.c_str(), error.what());
    return exit_code(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "affskel-worker: %s\n", error.what());
    return kBadInput;
  }
}
