// Processes killed, ended, stopped.
#include <csignal>
#include <filesystem>

#include "faults.h"
#include "tools/files.h"
#include "wire/words.h"

namespace affskel::chaos {
namespace {

constexpr Milliseconds kProcessCall{5000};

/// The command line of the owner of all other jobs, so that what it submits is seen by way of the proxy, too.
std::vector<std::string> client(const Scene& scene, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {scene.stage.programs().client, "--server", scene.stage.address(),
                                       "--token-file", scene.stage.access_of(kClientOwner).token_file});
  return arguments;
}

std::vector<std::string> submit_command(const Scene& scene, const Submission& submission,
                                        const std::string& file) {
  return client(
      scene, {"submit", file, "--points", std::to_string(submission.params.sampling().target_points()),
              "--directions", submission.params.directions(), "--operator", wire::word(submission.skeleton),
              "--name", submission.name, "--request-id", submission.request_id});
}

/// Writes down that the command line said a job's id.
void note_job(Scene& scene, const Submission& submission, const std::string& id) {
  v1::Job job;
  const grpc::Status status =
      until_answered("asking for a job", [&] { return scene.stage.api().job(id, job, kProcessCall); });
  if (!status.ok()) return scene.complain(submission.name + ": acknowledged, and " + status.error_message());
  scene.complain(scene.ledger.submitted(submission.name, submission.mesh_sha256, submission.recipe, job));
}

/// The exit code of a process that was told to leave in order; 128 when it does not.
int leave(Process& process, const std::string& who) {
  const auto code = process.wait(kPatience);
  if (!code) throw Hang(who + " does not end");
  return *code;
}

void must_be_zero(int code, const std::string& who) {
  if (code != 0) throw std::runtime_error(who + " was told to end, and did so with " + std::to_string(code));
}

void stop(const Process& process, const std::function<void()>& meanwhile) {
  process.send(SIGSTOP);
  meanwhile();
  process.send(SIGCONT);
}

}  // namespace

bool kill_server(Scene& scene) {
  scene.stage.server().kill_hard();
  scene.stage.start_server();
  return true;
}

bool kill_worker(Scene& scene) {
  const std::size_t which = scene.pick(kWorkers);
  scene.stage.worker(which).kill_hard();
  scene.stage.start_worker(which);
  return true;
}

bool kill_all(Scene& scene) {
  scene.stage.start_over();
  return true;
}

bool kill_server_amid_submissions(Scene& scene) {
  constexpr std::size_t kClients = 6;
  std::vector<Submission> submissions;
  for (std::size_t i = 0; i < kClients; ++i)
    submissions.push_back(scene.catalogue.next(kTiny, scene.new_name()));
  const Milliseconds moment(scene.pick(30));
  {
    std::vector<std::jthread> clients;
    for (const Submission& submission : submissions) {
      clients.emplace_back([&] { scene.submit(scene.stage.api(), submission, Milliseconds(2000)); });
    }
    last_for(moment);
    scene.stage.server().kill_hard();
    scene.stage.start_server();
  }
  for (const Submission& submission : submissions) scene.submit_patiently(scene.stage.api(), submission);
  return true;
}

// Whether or not the first attempt got there: the same again is the same job.
bool kill_submitting_client(Scene& scene) {
  const Submission submission = scene.catalogue.next(kMedium, scene.new_name());
  const std::string stem = scene.stage.path(submission.name);
  tests::write_file(stem + ".off", submission.mesh);
  const std::vector<std::string> command = submit_command(scene, submission, stem + ".off");
  Process process({command, stem + ".1", "", {}});
  const bool ended = process.wait(Milliseconds(scene.pick(60))).has_value();
  process.kill_hard();
  if (run({command, stem + ".2", scene.stage.path("client.log"), {}}, kPatience) != 0) {
    scene.complain(submission.name + ": a killed client's submission cannot be repeated");
    return true;
  }
  const std::string before = tests::read_file(stem + ".1"), after = tests::read_file(stem + ".2");
  if (!before.empty() && before != after) scene.complain(submission.name + ": two jobs, " + before + after);
  note_job(scene, submission, after.substr(0, 32));
  return !ended;
}

bool kill_fetching_client(Scene& scene) {
  std::string done;
  for (const auto& [id, entry] : scene.ledger.entries()) {
    if (entry.verified && entry.recipe != kTiny) done = id;
  }
  if (done.empty()) return false;
  const std::string file = scene.stage.path("killed.csv"), whole = scene.stage.path("whole.csv");
  std::filesystem::remove(file);
  Process process({client(scene, {"fetch", done, "field", "-o", file}), "", "", {}});
  const bool ended = process.wait(Milliseconds(scene.pick(30))).has_value();
  process.kill_hard();
  if (!std::filesystem::exists(file)) return !ended;
  if (run({client(scene, {"fetch", done, "field", "-o", whole}), "", "", {}}, kPatience) != 0) {
    throw std::runtime_error("a field cannot be fetched by the command line");
  }
  const auto where = difference(tests::read_file(file), tests::read_file(whole));
  if (where) scene.complain("a killed client left half a file: " + *where);
  return !ended;
}

bool term_server(Scene& scene) {
  scene.stage.server().send(SIGTERM);
  const int code = leave(scene.stage.server(), "the draining server");
  scene.stage.start_server();
  must_be_zero(code, "the server");
  return true;
}

bool term_server_twice(Scene& scene) {
  scene.stage.server().send(SIGTERM);
  last_for(Milliseconds(scene.pick(50)));
  scene.stage.server().send(SIGTERM);
  leave(scene.stage.server(), "the server that got SIGTERM twice");
  scene.stage.start_server();
  return true;
}

bool kill_draining_server(Scene& scene) {
  scene.stage.server().send(SIGTERM);
  last_for(Milliseconds(scene.pick(30)));
  scene.stage.server().kill_hard();
  scene.stage.start_server();
  return true;
}

bool term_worker(Scene& scene) {
  const std::size_t which = scene.pick(kWorkers);
  scene.stage.worker(which).send(SIGTERM);
  const int code = leave(scene.stage.worker(which), "a worker");
  scene.stage.start_worker(which);
  must_be_zero(code, "a worker");
  return true;
}

bool term_worker_twice(Scene& scene) {
  const std::size_t which = scene.pick(kWorkers);
  scene.stage.worker(which).send(SIGTERM);
  scene.stage.worker(which).send(SIGTERM);
  leave(scene.stage.worker(which), "a worker that got SIGTERM twice");
  scene.stage.start_worker(which);
  return true;
}

bool stop_server(Scene& scene) {
  stop(scene.stage.server(), outlast_lease);
  return true;
}

bool stop_worker(Scene& scene) {
  stop(scene.stage.worker(scene.pick(kWorkers)), outlast_lease);
  return true;
}

bool stop_all(Scene& scene) {
  stop(scene.stage.server(),
       [&] { stop(scene.stage.worker(0), [&] { stop(scene.stage.worker(1), outlast_lease); }); });
  return true;
}

bool second_server(Scene& scene) {
  const Stage& stage = scene.stage;
  const auto code = run({{stage.programs().server, "--data-dir", stage.data_dir(), "--listen",
                          "unix:" + stage.path("second.sock")},
                         "",
                         stage.path("second.log"),
                         {}},
                        kPatience);
  if (!code) throw Hang("a second server on the same data directory does not end");
  if (*code == 0) scene.complain("a second server on the same data directory was let in");
  return true;
}

}  // namespace affskel::chaos
