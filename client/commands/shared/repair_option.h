#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "client/commands/shared/context.h"
#include "client/operations/repair.h"

namespace affskel::client {

/// --repair. @param what its values do, for the help.
void add_repair_option(CLI::App* command, std::string& how, const std::string& what);

/// What it says: "auto", "none", "fill=LENGTH", "wrap" or "wrap=ALPHA".
/// @throws ClientError kUsage for anything else.
RepairChoice chosen_repair(const std::string& text);

/// Steps of a repair as JSON: code, count, message.
nlohmann::ordered_json steps_json(const std::vector<core::RepairStep>& steps);

/// The repaired mesh, which bounds a solid.
/// @param file as the user named it.
/// @throws ClientError kBadInput where something is left, with the commands that would do it; as repair.
Repair repaired(const Context& context, const core::Mesh& mesh, const std::string& file,
                const RepairChoice& choice);

}  // namespace affskel::client
