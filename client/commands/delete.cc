#include <nlohmann/json.hpp>

#include "client/commands/commands.h"
#include "client/commands/job_command.h"

namespace affskel::client {
namespace {

void run_delete(Context& context, const std::string& name) {
  const std::string id = context.session().delete_job(name);
  context.console().result("deleted\n");
  context.console().document({{"id", id}, {"state", "deleted"}});
}

}  // namespace

void add_delete(CommandLine& line) {
  add_job_command(line, "delete", "Remove a job and everything that belongs to it",
                  "  affskel-client delete 3f2a9c", run_delete);
}

}  // namespace affskel::client
