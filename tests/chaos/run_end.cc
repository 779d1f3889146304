// The end of a run: everything is finished and compared; one job is left unfinished on purpose, and a copy of
// the data directory must finish it to the same bytes.
#include <csignal>
#include <filesystem>

#include "run.h"
#include "wire/sha256.h"

namespace affskel::chaos {
namespace {

constexpr Milliseconds kEndCall{10000};

}  // namespace

Outcome Run::end() {
  Outcome outcome;
  std::string unfinished;
  guarded(outcome, [&] {
    finish_all();
    audit();
    compare_all(stage_.api());
    unfinished = leave_one_unfinished();
  });
  guarded(outcome, [&] { end_processes(); });
  const std::string faults_found = stage_.check(options_.data_dir);
  if (!faults_found.empty()) {
    ++outcome.unclean;
    note("UNCLEAN " + faults_found);
  }
  if (!unfinished.empty()) guarded(outcome, [&] { go_on_with_a_copy(unfinished, outcome); });
  collect(outcome);
  return outcome;
}

void Run::finish_all() {
  for (const auto& [id, entry] : ledger_.entries()) {
    if (entry.wish != Ledger::Wish::kRun) continue;
    for (int attempt = 0; attempt < 3; ++attempt) {
      v1::Job job = stage_.api().follow(id, [](const v1::Job&) { return false; });
      if (job.state() == v1::JOB_STATE_DONE) break;
      const std::string name = id;
      until_answered("resuming", [&] { return stage_.api().resume(name, job, kEndCall); });
      ledger_.resumed(job);
    }
  }
}

void Run::compare_all(const Api& api) {
  for (const auto& [id, entry] : ledger_.entries()) {
    if (entry.wish == Ledger::Wish::kRun && entry.floor.state() == v1::JOB_STATE_DONE) {
      compare_artefacts(api, id, entry);
    }
  }
}

void Run::compare_artefacts(const Api& api, const std::string& id, const Ledger::Entry& entry) {
  scene_.compare_field(api, id, entry.recipe);
  std::string bytes;
  const auto get = [&](v1::ArtifactKind kind) {
    const grpc::Status status =
        until_answered("fetching", [&] { return api.fetch(artefact(id, kind), bytes, kEndCall); });
    if (!status.ok()) scene_.complain(entry.name + ": no artefact: " + status.error_message());
    return status.ok();
  };
  if (get(v1::ARTIFACT_KIND_SKELETON)) {
    const auto where = difference(bytes, catalogue_.reference(entry.recipe).skeleton);
    if (where) scene_.differ(entry.name + ": skeleton: " + *where);
  }
  if (get(v1::ARTIFACT_KIND_MESH) && wire::sha256_hex(bytes) != entry.mesh_sha256) {
    scene_.complain(entry.name + ": the mesh is not the one that was submitted");
  }
}

std::string Run::leave_one_unfinished() {
  const std::string id =
      scene_.submit_patiently(stage_.api(), catalogue_.next(kLongTorus, scene_.new_name()));
  ledger_.saw(stage_.api().follow(id, [](const v1::Job& job) {
    return job.directions_total() > 0 && job.directions_done() * 4 > job.directions_total();
  }));
  return id;
}

void Run::end_processes() {
  for (std::size_t i = 0; i < kWorkers; ++i) stage_.worker(i).kill_hard();
  if (options_.seed % 2 != 0) return stage_.server().kill_hard();
  stage_.server().send(SIGTERM);
  if (stage_.server().wait(kPatience) != 0) throw Hang("the server does not end, or not well");
}

void Run::go_on_with_a_copy(const std::string& unfinished, Outcome& outcome) {
  const std::string dir = options_.dir + "/copy";
  std::filesystem::create_directories(dir);
  std::filesystem::copy(options_.data_dir, dir + "/data", std::filesystem::copy_options::recursive);
  Stage fresh(stage_.programs(), dir, dir + "/data");
  fresh.start_server();
  fresh.wait_for_server();
  std::vector<v1::Job> jobs;
  until_answered("listing jobs", [&] { return fresh.api().list(jobs, kEndCall); });
  scene_.complain(ledger_.audit(with_progress(fresh.api(), std::move(jobs))));
  fresh.start_workers();
  const v1::Job job = fresh.api().follow(unfinished, [](const v1::Job&) { return false; });
  ledger_.saw(job);
  if (job.state() != v1::JOB_STATE_DONE) scene_.complain(job.name() + ": a copy cannot finish it");
  compare_all(fresh.api());
  fresh.server().send(SIGTERM);
  if (fresh.server().wait(kPatience) != 0) scene_.complain("the copy's server does not end well");
  const std::string faults_found = fresh.check(dir + "/data");
  if (faults_found.empty()) return;
  ++outcome.unclean;
  note("UNCLEAN copy: " + faults_found);
}

}  // namespace affskel::chaos
