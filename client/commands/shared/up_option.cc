#include "client/commands/shared/up_option.h"

#include <CLI/CLI.hpp>

#include "client/cli/value_checks.h"

namespace affskel::client {

void add_up(CLI::App* command, std::string& up) {
  command
      ->add_option("--up", up,
                   "Axis that points up: x, y or z (default: z, or y where the shape stands\nalong y)")
      ->check(one_of({"x", "y", "z"}))
      ->type_name("AXIS");
}

std::optional<UpAxis> chosen_up(const std::string& name) {
  for (const UpAxis up : {UpAxis::kX, UpAxis::kY, UpAxis::kZ}) {
    if (name == std::string(1, up_letter(up))) return up;
  }
  return std::nullopt;
}

}  // namespace affskel::client
