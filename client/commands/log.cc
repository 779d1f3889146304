#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/job_options.h"
#include "client/text/event_text.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

void run_log(Context& context, const std::string& name) {
  const v1::ListJobEventsResponse response = context.session().job_events(name);
  context.console().result(event_lines(response));
  // Every line is an event; the last one also says whose values the job has by now.
  nlohmann::ordered_json told = to_json(response);
  nlohmann::ordered_json& events = told["events"];
  if (!events.empty()) events.back()["givers"] = told["givers"];
  for (const nlohmann::ordered_json& event : events) {
    nlohmann::ordered_json document = {{"job", told["job"]}};
    document.update(event);
    context.console().document(document);
  }
}

}  // namespace

void add_log(CommandLine& line) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command =
      line.add("log", "What happened to a job, oldest first",
               "  affskel-client log @last\n"
               "  affskel-client --json log @last | jq -r 'select(.event == \"lease_lost\").worker'\n"
               "  affskel-client --json log @last | jq -r '.givers[]?.worker'",
               [job](Context& context) { run_log(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
