// Clients: many, contradictory, slow or absent-minded.
#include <algorithm>
#include <set>

#include "faults.h"

namespace affskel::chaos {
namespace {

constexpr Milliseconds kStormCall{10000};

std::vector<Submission> several(Scene& scene, std::size_t recipe, std::size_t number) {
  std::vector<Submission> submissions;
  for (std::size_t i = 0; i < number; ++i)
    submissions.push_back(scene.catalogue.next(recipe, scene.new_name()));
  return submissions;
}

/// Jobs that are done and were compared.
std::vector<std::pair<std::string, std::size_t>> finished(const Scene& scene) {
  std::vector<std::pair<std::string, std::size_t>> jobs;
  for (const auto& [id, entry] : scene.ledger.entries()) {
    if (entry.verified && entry.wish == Ledger::Wish::kRun) jobs.emplace_back(id, entry.recipe);
  }
  return jobs;
}

/// Cancels, and deletes once the job is final; a job that was done before the cancel is deleted as well.
void cancel_and_delete(Scene& scene, const std::string& id) {
  const Api& api = scene.stage.api();
  v1::Job job;
  const grpc::Status cancelled =
      until_answered("cancelling", [&] { return api.cancel(id, job, kStormCall); });
  if (cancelled.ok()) scene.ledger.cancelled(job);
  api.follow(id, [](const v1::Job&) { return false; });
  scene.ledger.deleting(id);
  const grpc::Status removed = until_answered("deleting", [&] { return api.remove(id, kStormCall); });
  // Of a call that is repeated the first may have got there.
  if (removed.ok() || removed.error_code() == grpc::StatusCode::NOT_FOUND) {
    scene.ledger.deleted(id);
  } else {
    scene.complain("a cancelled job cannot be deleted: " + removed.error_message());
  }
}

/// Follows the running job to the end of its cancel: false when it was done before its workers heard of it.
bool stays_cancelled(Scene& scene) {
  const Api& api = scene.stage.api();
  v1::Job job = api.follow(scene.running_job, [](const v1::Job&) { return false; });
  if (job.state() == v1::JOB_STATE_DONE) return false;
  const grpc::Status status =
      until_answered("asking for a job", [&] { return api.job(scene.running_job, job, kStormCall); });
  if (!status.ok() || job.state() != v1::JOB_STATE_CANCELLED) {
    scene.complain(job.name() + ": cancelled, and then " + v1::JobState_Name(job.state()));
  }
  return true;
}

/// A call that stays open, and its end.
struct OpenFetch {
  grpc::ClientContext context;
  std::unique_ptr<grpc::ClientReader<v1::FetchArtifactResponse>> reader;
};

struct OpenWatch {
  grpc::ClientContext context;
  std::unique_ptr<grpc::ClientReader<v1::Job>> reader;
};

struct OpenUpload {
  grpc::ClientContext context;
  v1::SubmitJobResponse response;
  std::unique_ptr<grpc::ClientWriter<v1::SubmitJobRequest>> writer;
};

template <class Open>
void end_storm(std::vector<std::unique_ptr<Open>>& calls) {
  for (const auto& call : calls) call->context.TryCancel();
}

}  // namespace

bool duplicate_submissions(Scene& scene) {
  const Submission submission = scene.catalogue.next(kTiny, scene.new_name());
  std::vector<std::string> ids(8);
  in_parallel(ids.size(), [&](std::size_t i) {
    const Api& api = i % 2 == 0 ? scene.stage.api() : scene.stage.proxied();
    Submission mine = submission;
    if (i >= 4) mine.request_id.clear();  // the content alone finds the job, too
    ids[i] = scene.submit(api, mine, kStormCall);
  });
  const std::string id = scene.submit_patiently(scene.stage.api(), submission);
  for (const std::string& other : ids) {
    if (!other.empty() && other != id)
      scene.complain(submission.name + ": two jobs, " + id + " and " + other);
  }
  return true;
}

bool submit_storm(Scene& scene) {
  const std::vector<Submission> submissions = several(scene, kTiny, 24);
  in_parallel(8, [&](std::size_t client) {
    for (std::size_t i = client; i < submissions.size(); i += 8) {
      scene.submit(i % 2 == 0 ? scene.stage.api() : scene.stage.proxied(), submissions[i], kStormCall);
    }
  });
  for (const Submission& submission : submissions) scene.submit_patiently(scene.stage.api(), submission);
  return true;
}

bool cancel_resume_storm(Scene& scene) {
  const Api& api = scene.stage.api();
  in_parallel(4, [&](std::size_t client) {
    for (std::size_t i = 0; i < 6; ++i) {
      v1::Job job;
      static_cast<void>((client + i) % 2 == 0 ? api.cancel(scene.running_job, job, kStormCall)
                                              : api.resume(scene.running_job, job, kStormCall));
    }
  });
  // What it is told when no call contradicts any more must hold.
  v1::Job job;
  const grpc::Status cancelled =
      until_answered("cancelling", [&] { return api.cancel(scene.running_job, job, kStormCall); });
  if (!cancelled.ok()) return false;  // done meanwhile
  scene.ledger.cancelled(job);
  if (!stays_cancelled(scene)) return true;
  const grpc::Status resumed =
      until_answered("resuming", [&] { return api.resume(scene.running_job, job, kStormCall); });
  if (resumed.ok()) scene.ledger.resumed(job);
  return true;
}

bool delete_storm(Scene& scene) {
  const std::vector<Submission> submissions = several(scene, kMedium, 6);
  in_parallel(submissions.size(), [&](std::size_t i) {
    try {
      cancel_and_delete(scene, scene.submit_patiently(scene.stage.api(), submissions[i]));
    } catch (const Hang& hang) {
      scene.hang(hang.what());
    }
  });
  return true;
}

bool fetch_storm(Scene& scene) {
  const auto jobs = finished(scene);
  if (jobs.empty()) return false;
  const std::size_t from = scene.pick(jobs.size());
  const double threshold = 5.0 + static_cast<double>(scene.pick(1000)) / 100;
  in_parallel(8, [&](std::size_t client) {
    const auto& [id, recipe] = jobs[(from + client) % jobs.size()];
    const Api& api = client % 2 == 0 ? scene.stage.api() : scene.stage.proxied();
    try {
      for (int i = 0; i < 3; ++i) scene.compare_field(api, id, recipe);
    } catch (const Hang& hang) {
      scene.hang(hang.what());
    }
    v1::FetchArtifactRequest skeleton = artefact(id, v1::ARTIFACT_KIND_SKELETON);
    skeleton.mutable_skeleton()->set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
    skeleton.mutable_skeleton()->set_threshold(threshold);
    std::string bytes;
    static_cast<void>(api.fetch(skeleton, bytes, kStormCall));
  });
  return true;
}

bool stalled_fetches(Scene& scene) {
  const auto jobs = finished(scene);
  if (jobs.empty()) return false;
  std::vector<std::unique_ptr<OpenFetch>> calls;
  for (std::size_t i = 0; i < 12; ++i) {
    calls.push_back(std::make_unique<OpenFetch>());
    const auto request = artefact(jobs[i % jobs.size()].first, v1::ARTIFACT_KIND_FIELD);
    calls.back()->reader = scene.stage.proxied().client().FetchArtifact(&calls.back()->context, request);
  }
  outlast_lease();
  end_storm(calls);
  return true;
}

bool watch_storm(Scene& scene) {
  std::vector<std::unique_ptr<OpenWatch>> calls;
  v1::WatchJobRequest request;
  request.set_job(scene.running_job);
  for (std::size_t i = 0; i < 60; ++i) {
    calls.push_back(std::make_unique<OpenWatch>());
    const Api& api = i % 2 == 0 ? scene.stage.api() : scene.stage.proxied();
    calls.back()->context.set_deadline(std::chrono::system_clock::now() + kStormCall);
    calls.back()->reader = api.client().WatchJob(&calls.back()->context, request);
  }
  v1::Job job;
  for (std::size_t i = 0; i < calls.size(); i += 2) {
    if (calls[i]->reader->Read(&job)) scene.ledger.saw(job);
  }
  end_storm(calls);
  return true;
}

bool slow_uploads(Scene& scene) {
  const std::vector<Submission> submissions = several(scene, kMedium, 20);
  std::vector<std::unique_ptr<OpenUpload>> calls;
  for (const Submission& submission : submissions) {
    calls.push_back(std::make_unique<OpenUpload>());
    OpenUpload& call = *calls.back();
    call.writer = scene.stage.api().client().SubmitJob(&call.context, &call.response);
    v1::SubmitJobRequest header;
    header.mutable_header()->set_name(submission.name);
    *header.mutable_header()->mutable_params() = submission.params;
    header.mutable_header()->set_mesh_sha256(submission.mesh_sha256);
    header.mutable_header()->set_mesh_bytes(submission.mesh.size());
    call.writer->Write(header);
  }
  for (std::size_t second = 0; second < 2; ++second) {
    v1::SubmitJobRequest byte;
    for (std::size_t i = 0; i < calls.size(); ++i) {
      byte.set_data(submissions[i].mesh.substr(second, 1));
      calls[i]->writer->Write(byte);
    }
    // Others get their turn meanwhile.
    scene.submit_patiently(scene.stage.api(), scene.catalogue.next(kTiny, scene.new_name()));
    last_for(Milliseconds(1000));
  }
  end_storm(calls);
  return true;
}

}  // namespace affskel::chaos
