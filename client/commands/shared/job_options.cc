#include "client/commands/shared/job_options.h"

#include <CLI/CLI.hpp>

#include "client/cli/value_checks.h"

namespace affskel::client {

void add_job(CLI::App* command, std::string& job) {
  command->add_option("JOB", job, "Id, unique prefix of at least 6 characters, or @last")
      ->required()
      ->check(job_id())
      ->type_name("");
}

void add_output(CLI::App* command, std::string& output, const std::string& what) {
  command->add_option("-o,--output", output, what)->required()->check(non_empty())->type_name("FILE");
}

void add_format(CLI::App* command, std::string& format) {
  command->add_option("--format", format, "Format, whatever the file's name: csv, ply, ...")
      ->check(non_empty())
      ->type_name("EXT");
}

}  // namespace affskel::client
