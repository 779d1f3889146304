#include <algorithm>
#include <charconv>

#include "client/operations/artifact_calls.h"
#include "client/operations/job_notices.h"
#include "client/operations/kept_stance.h"
#include "client/text/message_json.h"
#include "client/web/api_answers.h"
#include "client/web/handlers.h"

namespace affskel::client {
namespace {

constexpr std::uint32_t kListed = 50, kMaxListed = 1000;

// Without what only programs read, which may be long; of a done job with what to know of its result.
nlohmann::ordered_json job_json(v1::Job job) {
  job.clear_done_positions();
  job.clear_counters();
  nlohmann::ordered_json json = to_json(job);
  if (job.state() == v1::JOB_STATE_DONE) json["warnings"] = warnings_json(end_notices(job));
  return json;
}

std::uint32_t limit_of(const http::Request& request) {
  const std::string text = request.parameter("limit");
  if (text.empty()) return kListed;
  std::uint32_t limit = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), limit);
  if (error != std::errc{} || end != text.data() + text.size() || limit < 1 || limit > kMaxListed)
    throw ClientError(ExitCode::kUsage, "'limit' must be from 1 to " + std::to_string(kMaxListed));
  return limit;
}

}  // namespace

http::Response list_jobs(WebCall& call) {
  const std::uint32_t limit = limit_of(call.request);
  v1::ListJobsRequest asked;
  if (call.request.parameter("everybody") != "1") asked.set_owner(call.session.user.owner);
  // One more than is shown tells whether there are more.
  const std::vector<v1::Job> jobs = call.server().list_jobs(asked, limit + 1);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(limit, jobs.size()); ++i)
    list.push_back(job_json(jobs[i]));
  return api_answer({{"jobs", list}, {"more", jobs.size() > limit}});
}

http::Response show_job(WebCall& call) {
  return api_answer(job_json(call.server().get_job(call.argument)));
}

http::Response cancel_job(WebCall& call) {
  return api_answer(job_json(call.server().cancel(call.argument)));
}

http::Response resume_job(WebCall& call) {
  return api_answer(job_json(call.server().resume(call.argument)));
}

http::Response delete_job(WebCall& call) {
  return api_answer({{"id", call.server().delete_job(call.argument)}});
}

http::Response pin_job(WebCall& call) {
  return api_answer(job_json(call.server().pin(call.argument)));
}

http::Response unpin_job(WebCall& call) {
  return api_answer(job_json(call.server().unpin(call.argument)));
}

http::Response set_stance(WebCall& call) {
  const StanceChoice choice = parse_stance(text_member(json_body(call.request), "stance"));
  Session server = call.server();
  const v1::Job job = server.get_job(call.argument);
  keep_stance(server, job, choice, fetch_mesh(server, job.id()));
  return api_answer(job_json(server.get_job(job.id())));
}

http::Response list_events(WebCall& call) {
  const v1::ListJobEventsResponse response = call.server().job_events(call.argument);
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  for (const v1::JobEvent& event : response.events()) events.push_back(to_json(event));
  return api_answer({{"events", events}});
}

}  // namespace affskel::client
