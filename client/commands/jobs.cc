// Commands about jobs as a whole: list, status, watch, cancel, resume, delete, server-info.
#include <google/protobuf/descriptor.h>

#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/text/job_text.h"
#include "client/text/message_json.h"
#include "client/text/server_text.h"
#include "client/text/time_text.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

v1::JobState state_named(const std::string& word) {
  const auto* type = v1::JobState_descriptor();
  for (int i = 0; i < type->value_count(); ++i) {
    if (enum_word(*type->value(i)) == word) return static_cast<v1::JobState>(type->value(i)->number());
  }
  throw ClientError(ExitCode::kUsage, "no job state '" + word + "'");
}

void show_state(Console& console, const v1::Job& job) {
  console.result(state_word(job.state()) + "\n");
  console.document(to_json(job));
}

}  // namespace

void run_list(Context& context, const ListOptions& options) {
  v1::ListJobsRequest request;
  for (const std::string& state : options.states) request.add_states(state_named(state));
  request.set_owner(options.owner);
  const std::vector<v1::Job> jobs = context.session().list_jobs(request, options.limit);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const v1::Job& job : jobs) list.push_back(to_json(job));
  context.console().document({{"jobs", list}});
  if (jobs.empty()) {
    context.console().note("no jobs");
  } else {
    context.console().result(job_table(jobs, unix_now_ms()));
  }
}

void run_status(Context& context, const JobOptions& options) {
  const v1::Job job = context.session().get_job(options.job);
  context.console().result(job_details(job));
  context.console().document(to_json(job));
}

void run_watch(Context& context, const JobOptions& options) {
  const v1::Job job = follow(context, options.job, true);
  context.console().result(state_word(job.state()) + "\n");
  throw_unless_done(job);
  warn_if_empty(context.console(), job.skeleton_points(), job.quality(), job);
}

void run_cancel(Context& context, const JobOptions& options) {
  v1::Job job = context.session().cancel(options.job);
  if (!is_final(job.state())) {
    // Workers stop at their next report.
    job = follow(context, job.id(), false);
  }
  show_state(context.console(), job);
}

void run_resume(Context& context, const JobOptions& options) {
  show_state(context.console(), context.session().resume(options.job));
}

void run_delete(Context& context, const JobOptions& options) {
  const std::string id = context.session().delete_job(options.job);
  context.console().result("deleted\n");
  context.console().document({{"id", id}, {"state", "deleted"}});
}

void run_server_info(Context& context) {
  const v1::ServerInfo info = context.session().server_info();
  context.console().result(server_details(info, unix_now_ms()));
  context.console().document(to_json(info));
}

}  // namespace affskel::client
