#include <memory>
#include <nlohmann/json.hpp>

#include "client/commands/commands.h"
#include "client/commands/shared/job_options.h"

namespace affskel::client {
namespace {

void run_delete(Context& context, const std::string& name) {
  const std::string id = context.session().delete_job(name);
  context.console().result("deleted\n");
  context.console().document({{"id", id}, {"state", "deleted"}});
}

}  // namespace

void add_delete(CommandLine& line) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command =
      line.add("delete", "Remove a job and everything that belongs to it", "  affskel-client delete 3f2a9c",
               [job](Context& context) { run_delete(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
