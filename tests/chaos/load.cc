#include "load.h"

#include <utility>

namespace affskel::chaos {
namespace {

constexpr Milliseconds kCall{1500};

}  // namespace

void Scene::complain(const std::string& what) {
  const std::lock_guard lock(mutex_);
  complaints_.push_back(what);
}

void Scene::complain(const std::vector<std::string>& all) {
  for (const std::string& one : all) complain(one);
}

std::vector<std::string> Scene::take_complaints() {
  const std::lock_guard lock(mutex_);
  return std::exchange(complaints_, {});
}

void Scene::differ(const std::string& what) {
  const std::lock_guard lock(mutex_);
  differences_.push_back(what);
}

void Scene::hang(const std::string& what) {
  const std::lock_guard lock(mutex_);
  hangs_.push_back(what);
}

std::vector<std::string> Scene::take_hangs() {
  const std::lock_guard lock(mutex_);
  return std::exchange(hangs_, {});
}

std::vector<std::string> Scene::take_differences() {
  const std::lock_guard lock(mutex_);
  return std::exchange(differences_, {});
}

std::string Scene::submit(const Api& api, const Submission& submission, Milliseconds limit) {
  v1::SubmitJobResponse response;
  if (!api.submit(submission, response, limit).ok()) return "";
  complain(ledger.submitted(submission.name, submission.mesh_sha256, submission.recipe, response.job()));
  return response.job().id();
}

std::string Scene::submit_patiently(const Api& api, const Submission& submission) {
  v1::SubmitJobResponse response;
  const grpc::Status status =
      until_answered("submitting", [&] { return api.submit(submission, response, Milliseconds(5000)); });
  if (!status.ok()) throw Hang("a submission is refused: " + status.error_message());
  complain(ledger.submitted(submission.name, submission.mesh_sha256, submission.recipe, response.job()));
  return response.job().id();
}

void Scene::compare_field(const Api& api, const std::string& id, std::size_t recipe) {
  std::string bytes;
  const grpc::Status status = until_answered("fetching a field", [&] {
    return api.fetch(artefact(id, v1::ARTIFACT_KIND_FIELD), bytes, Milliseconds(5000));
  });
  if (!status.ok())
    return complain("job " + id + " is done, its field not to be had: " + status.error_message());
  const auto where = difference(bytes, catalogue.reference(recipe).field);
  if (where) differ("field of job " + id + ", " + recipes()[recipe].name + ": " + *where);
}

Load::Load(Scene& scene) : scene_(scene), thread_([this] { work(); }) {}

Load::~Load() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Load::pause() {
  std::unique_lock lock(mutex_);
  paused_ = true;
  changed_.wait(lock, [this] { return !busy_; });
}

void Load::resume() {
  {
    const std::lock_guard lock(mutex_);
    paused_ = false;
  }
  changed_.notify_all();
}

bool Load::may_go() {
  std::unique_lock lock(mutex_);
  busy_ = false;
  changed_.notify_all();
  // Not faster than a job in a while, or there would be nothing but these.
  changed_.wait_for(lock, Milliseconds(150), [this] { return stop_; });
  changed_.wait(lock, [this] { return stop_ || !paused_; });
  busy_ = true;
  return !stop_;
}

void Load::work() {
  while (may_go()) step();
}

void Load::step() {
  const Api& api = ++steps_ % 2 == 0 ? scene_.stage.api() : scene_.stage.proxied();
  if (open_.name.empty()) open_ = scene_.catalogue.next(steps_ % 3 == 0 ? kMedium : kTiny, scene_.new_name());
  const std::string id = scene_.submit(api, open_, kCall);
  if (id.empty()) return;
  open_ = {};
  v1::Job job;
  if (api.job(id, job, kCall).ok()) scene_.ledger.saw(job);
}

}  // namespace affskel::chaos
