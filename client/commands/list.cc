#include <CLI/CLI.hpp>
#include <memory>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/text/job_text.h"
#include "client/text/message_json.h"
#include "client/text/time_text.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

struct ListOptions {
  std::vector<std::string> states;
  std::string owner;
  unsigned limit = 50;
};

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
    const ConsoleStyle& style = context.console().style();
    context.console().result(job_table(jobs, unix_now_ms(), style.out_colour, style.out_columns));
  }
}

}  // namespace

void add_list(CommandLine& line) {
  const auto options = std::make_shared<ListOptions>();
  CLI::App* command =
      line.add("list", "Jobs, newest first",
               "  affskel-client list\n  affskel-client list --state running --state queued --limit 10\n"
               "  affskel-client --json list | jq -r .jobs[].id",
               [options](Context& context) { run_list(context, *options); });
  command->add_option("--state", options->states, "Only jobs in this state; may be repeated")
      ->check(one_of(state_words()))
      ->type_name("STATE")
      ->allow_extra_args(false);
  command->add_option("--owner", options->owner, "Only this user's jobs")
      ->check(utf8_text())
      ->type_name("USER");
  command->add_option("--limit", options->limit, "At most this many")
      ->check(whole_number(1, 1000000))
      ->capture_default_str()
      ->type_name("N");
}

}  // namespace affskel::client
