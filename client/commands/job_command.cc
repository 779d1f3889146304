#include "client/commands/job_command.h"

#include <memory>
#include <utility>

#include "client/commands/shared/job_options.h"

namespace affskel::client {

void add_job_command(CommandLine& line, const std::string& name, const std::string& description,
                     const std::string& examples,
                     std::function<void(Context& context, const std::string& job)> run) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command = line.add(name, description, examples,
                               [job, run = std::move(run)](Context& context) { run(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
