#include "client/commands/shared/stance_option.h"

#include <CLI/CLI.hpp>

#include "client/cli/value_checks.h"

namespace affskel::client {

void add_stance(CLI::App* command, std::string& up) {
  command
      ->add_option("--up", up,
                   "What points up, and what the solid faces: x, -x, y, -y, z or -z each, such as\n"
                   "z,-y; the front is found where only UP is given. Kept with the job, for all who\n"
                   "draw it, until --up shape (default: as the shape tells)")
      ->check(non_empty())
      ->type_name("UP[,FRONT]");
}

StanceChoice chosen_stance(const std::string& up) {
  return up.empty() ? StanceChoice{} : parse_stance(up);
}

}  // namespace affskel::client
