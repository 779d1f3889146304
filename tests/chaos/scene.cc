#include "scene.h"

#include <algorithm>
#include <utility>

namespace affskel::chaos {

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

// Whether each way to the server still knows the job, by its id and in the list.
std::string Scene::whereabouts(const std::string& id) const {
  const auto known_to = [&](const Api& api) {
    v1::Job job;
    const grpc::Status status = api.job(id, job, Milliseconds(5000));
    std::vector<v1::Job> jobs;
    const bool listed =
        api.list(jobs, Milliseconds(5000)).ok() &&
        std::any_of(jobs.begin(), jobs.end(), [&](const v1::Job& one) { return one.id() == id; });
    return (status.ok() ? "known as " + v1::JobState_Name(job.state()) + " of " + job.owner()
                        : "asked for: " + status.error_message()) +
           (listed ? ", listed" : ", not listed");
  };
  return "directly " + known_to(stage.api()) + "; by the proxy " + known_to(stage.proxied());
}

void Scene::compare_field(const Api& api, const std::string& id, std::size_t recipe) {
  std::string bytes;
  const grpc::Status status = until_answered("fetching a field", [&] {
    return api.fetch(artefact(id, recipes()[recipe].field_kind()), bytes, Milliseconds(5000));
  });
  if (!status.ok()) {
    return complain("job " + id + " is done, its field not to be had: " + status.error_message() + "; " +
                    whereabouts(id));
  }
  const auto where = difference(bytes, catalogue.reference(recipe).field);
  if (where) differ("field of job " + id + ", " + recipes()[recipe].name + ": " + *where);
}

}  // namespace affskel::chaos
