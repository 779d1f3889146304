#pragma once

namespace affskel::load {

struct LoadOptions {
  int clients = 200;
  int workers = 50;
  int seconds = 30;
  int jobs = 10000;
  int megabytes = 1000;
  int kills = 20;
  int queued = 0;        ///< crowd: jobs that wait before it comes
  int watches = 0;       ///< crowd: streams that are open all the time
  bool metrics = false;  ///< crowd: the server tells metrics, and they are asked for all the time
};

/// Clients that submit, follow, ask and list at once, while made-up workers report.  Prints the times of the
/// calls and what the server held; with metrics, scrapes count as calls.  @returns whether nothing failed.
bool run_crowd(const LoadOptions& options);

/// A long queue: submits the jobs, then leases and lists.
bool run_queue(const LoadOptions& options);

/// Kills the server of a large database while a worker reports, and times its way back.
bool run_restart(const LoadOptions& options);

/// Kills the only worker at random moments, and times the work that is lost and the way back.
bool run_kills(const LoadOptions& options);

/// One owner's long queue and another's single job, with real workers: how long it takes, against its time on
/// the idle server.
bool run_turns(const LoadOptions& options);

/// Finished jobs, one in a hundred pinned, under a server that keeps results for a second: when they are
/// gone, and what is left of the database's file.
bool run_retention(const LoadOptions& options);

/// What workers cost the server, working, idle, and a thousand of them by simulation.
bool run_scale(const LoadOptions& options);

/// Many small jobs with real workers, one after the other; prints what server and workers hold meanwhile.
bool run_soak(const LoadOptions& options);

}  // namespace affskel::load
