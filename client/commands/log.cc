#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/job_options.h"
#include "client/text/event_text.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

void run(Context& context, const std::string& name) {
  const v1::ListJobEventsResponse response = context.session().job_events(name);
  context.console().result(event_lines(response));
  for (const v1::JobEvent& event : response.events()) {
    nlohmann::ordered_json document = {{"job", response.job()}};
    document.update(to_json(event));
    context.console().document(document);
  }
  for (const v1::Giver& giver : response.givers()) {
    context.console().document({{"job", response.job()}, {"giver", to_json(giver)}});
  }
}

}  // namespace

void add_log(CommandLine& line) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command =
      line.add("log", "What happened to a job, oldest first",
               "  affskel-client log @last\n"
               "  affskel-client --json log @last | jq -r 'select(.event == \"lease_lost\").worker'",
               [job](Context& context) { run(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
