#include "run.h"

#include <algorithm>
#include <array>
#include <iostream>

namespace affskel::chaos {
namespace {

constexpr Milliseconds kRunCall{5000};
constexpr std::size_t kKeptJobs = 10;

double share(const v1::Job& job) {
  if (job.params().minimum() == v1::MINIMUM_INFIMUM) {
    // By far the most of it is the refinement, and of this round 0; the others count as they come.
    const double points = static_cast<double>(std::max<std::uint64_t>(1, job.prepared().points()));
    const double round = static_cast<double>(job.refined_points()) / points;
    return job.refine_round() == 0 ? 0.4 * round : std::min(1.0, 0.4 + 0.05 * (job.refine_round() + round));
  }
  return job.directions_total() == 0
             ? 0
             : static_cast<double>(job.directions_done()) / static_cast<double>(job.directions_total());
}

}  // namespace

Run::Run(const Programs& programs, const Catalogue& catalogue, RunOptions options)
    : catalogue_(catalogue),
      options_(std::move(options)),
      stage_(programs, options_.dir, options_.data_dir, options_.tls),
      scene_(stage_, catalogue, ledger_, "s" + std::to_string(options_.seed) + "-", options_.seed),
      load_(scene_) {}

bool Run::go(Tally& tally) {
  now_ = "start";
  stage_.start_server();
  stage_.start_workers();
  stage_.wait_for_server();
  stage_.wait_for_workers();
  std::size_t number = 0;
  for (const Fault* fault : options_.faults) {
    now_ = "fault " + std::to_string(++number) + ", " + fault->name;
    tally.add(fault->name, disturb(*fault));
  }
  now_ = "end";
  tally.add("end of the run", end());
  return good_;
}

void Run::note(const std::string& what) {
  std::cerr << "seed " << options_.seed << ", " << now_ << ": " << what << std::endl;
}

void Run::guarded(Outcome& outcome, const std::function<void()>& step) {
  try {
    step();
  } catch (const Hang& hang) {
    ++outcome.hangs;
    note(std::string("HANG ") + hang.what());
    stage_.start_over();
  } catch (const std::exception& error) {
    scene_.complain(error.what());
  }
}

Outcome Run::disturb(const Fault& fault) {
  Outcome outcome;
  outcome.injected = 1;
  guarded(outcome, [&] {
    make_sure_of_a_running_job();
    load_.resume();
    if (!fault.inject(scene_)) ++outcome.without_effect;
  });
  stage_.calm();
  guarded(outcome, [&] { recover(fault, outcome); });
  load_.pause();
  guarded(outcome, [&] {
    audit();
    look_at_finished();
    tidy_up();
  });
  const std::string faults_found = stage_.check(options_.data_dir);
  if (!faults_found.empty()) {
    ++outcome.unclean;
    note("UNCLEAN " + faults_found);
  }
  collect(outcome);
  return outcome;
}

void Run::collect(Outcome& outcome) {
  for (const std::string& what : scene_.take_differences()) {
    ++outcome.differing;
    note("DIFFERS " + what);
  }
  for (const std::string& what : scene_.take_complaints()) {
    ++outcome.lost;
    note("LOST " + what);
  }
  for (const std::string& what : scene_.take_hangs()) {
    ++outcome.hangs;
    note("HANG " + what);
  }
  good_ = good_ && outcome.good();
}

void Run::make_sure_of_a_running_job() {
  v1::Job job;
  if (!scene_.running_job.empty()) {
    const grpc::Status status = until_answered(
        "asking for a job", [&] { return stage_.api().job(scene_.running_job, job, kRunCall); });
    if (status.ok() && !is_final(job) && share(job) < 0.5) return;
  }
  const std::size_t recipe = std::array{kLongTorus, kLongBody, kInfimum}[scene_.pick(3)];
  scene_.running_job = scene_.submit_patiently(stage_.api(), catalogue_.next(recipe, scene_.new_name()));
  const double moment = 0.02 + 0.004 * static_cast<double>(scene_.pick(100));
  ledger_.saw(
      stage_.api().follow(scene_.running_job, [&](const v1::Job& now) { return share(now) >= moment; }));
}

void Run::recover(const Fault& fault, Outcome& outcome) {
  const Clock::time_point begun = Clock::now();
  const auto all_work = [&] {
    bring_up(fault.may_end, outcome);
    canary();
    stage_.wait_for_workers();
  };
  try {
    all_work();
  } catch (const Hang&) {
    if (stage_.server().alive()) throw;
  }
  // A server that has become deaf leaves after a while, and is to be started again.
  if (!stage_.server().alive()) all_work();
  outcome.recovery += std::chrono::duration_cast<Milliseconds>(Clock::now() - begun);
  ++outcome.recoveries;
}

// What was ended by a signal that came late, or by too little memory, ends once more at most.
void Run::bring_up(std::uint32_t may_end, Outcome& outcome) {
  for (int i = 0; i < 3; ++i) {
    const std::vector<std::string> dead = stage_.restart_dead();
    for (const std::string& who : dead) {
      const bool server = who.rfind("server", 0) == 0;
      const bool may = (may_end & (server ? kServer : kAWorker)) != 0;
      if (!may) ++outcome.deaths;
      note((may ? "ended, as it may: " : "DEATH ") + who);
    }
    stage_.wait_for_server();
    if (stage_.server().alive()) return;
  }
  throw Hang("the server does not stay");
}

void Run::canary() {
  Submission bird = catalogue_.next(kTiny, scene_.new_name());
  bird.priority = 9;
  const std::string id = scene_.submit_patiently(stage_.api(), bird);
  const v1::Job job = stage_.api().follow(id, [](const v1::Job&) { return false; });
  if (job.state() != v1::JOB_STATE_DONE) {
    return scene_.complain(bird.name + ", new after the fault, ended as " + v1::JobState_Name(job.state()) +
                           ": " + job.error().message());
  }
  scene_.compare_field(stage_.api(), id, kTiny);
  ledger_.verified(id);
}

std::vector<v1::Job> Run::with_progress(const Api& api, std::vector<v1::Job> jobs) {
  for (v1::Job& job : jobs) {
    if (job.state() == v1::JOB_STATE_DONE || job.directions_done() == 0) continue;
    const std::string id = job.id();
    until_answered("asking for a job", [&] { return api.job(id, job, kRunCall); });
  }
  return jobs;
}

void Run::audit() {
  std::vector<v1::Job> jobs;
  const grpc::Status status =
      until_answered("listing jobs", [&] { return stage_.api().list(jobs, kRunCall); });
  if (!status.ok()) return scene_.complain("jobs cannot be listed: " + status.error_message());
  jobs = with_progress(stage_.api(), std::move(jobs));
  scene_.complain(ledger_.audit(jobs));
  for (const v1::Job& job : jobs) {
    if (job.state() != v1::JOB_STATE_FAILED) continue;
    note("resumed " + job.name() + ", which failed: " + job.error().code() + " " + job.error().message());
    v1::Job resumed;
    until_answered("resuming", [&] { return stage_.api().resume(job.id(), resumed, kRunCall); });
  }
}

void Run::look_at_finished() {
  for (const auto& [id, entry] : ledger_.entries()) {
    if (entry.verified || entry.wish == Ledger::Wish::kGone || entry.floor.state() != v1::JOB_STATE_DONE)
      continue;
    scene_.compare_field(stage_.api(), id, entry.recipe);
    ledger_.verified(id);
  }
}

// Some jobs stay: to be fetched, and to be there at the end.
void Run::tidy_up() {
  std::size_t kept = 0;
  for (const auto& [id, entry] : ledger_.entries()) {
    if (!entry.verified || entry.wish == Ledger::Wish::kGone || ++kept <= kKeptJobs) continue;
    ledger_.deleting(id);
    const std::string job = id;
    const grpc::Status status =
        until_answered("deleting", [&] { return stage_.api().remove(job, kRunCall); });
    if (status.ok() || status.error_code() == grpc::StatusCode::NOT_FOUND) ledger_.deleted(id);
  }
}

}  // namespace affskel::chaos
