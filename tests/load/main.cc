// affskel_load: loads on a real server, started here, and what it makes of them.

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "loads.h"

int main(int argc, char** argv) {
  using namespace affskel::load;
  LoadOptions options;
  CLI::App app("Loads on a real server: how fast it answers, what it holds");
  app.add_option("--clients", options.clients, "crowd: clients at once")->capture_default_str();
  app.add_option("--workers", options.workers,
                 "crowd, scale: made-up workers; scale: idle ones, too; soak, turns: real ones, at most 2")
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "crowd, scale: how long; turns: roughly, alone on one worker")
      ->capture_default_str();
  app.add_option("--jobs", options.jobs, "queue, soak, turns, retention: number of jobs")
      ->capture_default_str();
  app.add_option("--megabytes", options.megabytes, "restart: size of the database")->capture_default_str();
  app.add_option("--kills", options.kills, "kills: how many")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--queued", options.queued, "crowd: jobs that wait before it comes")->capture_default_str();
  app.add_option("--watches", options.watches,
                 "crowd: streams that are open all the time, on what was queued")
      ->capture_default_str();
  app.add_flag("--metrics", options.metrics, "crowd: scrape the server's metrics once a second meanwhile");
  app.fallthrough();
  app.require_subcommand(1);
  bool good = true;
  const auto run = [&](bool (*load)(const LoadOptions&)) {
    return [&good, &options, load] { good = load(options) && good; };
  };
  app.add_subcommand("crowd", "Clients that submit and follow, workers that report")
      ->callback(run(run_crowd));
  app.add_subcommand("queue", "A long queue: leases and lists")->callback(run(run_queue));
  app.add_subcommand("restart", "A server of a large database is killed")->callback(run(run_restart));
  app.add_subcommand("kills", "The only worker is killed at random moments")->callback(run(run_kills));
  app.add_subcommand("scale", "What workers cost the server, and what a thousand would")
      ->callback(run(run_scale));
  app.add_subcommand("soak", "Many small jobs, one after the other")->callback(run(run_soak));
  app.add_subcommand("turns", "One owner's long queue and another's single job")->callback(run(run_turns));
  app.add_subcommand("retention", "Many finished jobs are removed by age")->callback(run(run_retention));
  app.add_subcommand("all", "All of them but scale, which takes minutes")->callback([&] {
    for (auto* load : {run_crowd, run_queue, run_restart, run_kills, run_turns, run_soak, run_retention})
      run(load)();
  });
  try {
    app.parse(argc, argv);
    return good ? 0 : 1;
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::cerr << "affskel_load: " << error.what() << '\n';
    return 1;
  }
}
