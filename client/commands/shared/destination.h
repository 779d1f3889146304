#pragma once

#include <string>

#include "client/cli/console.h"
#include "client/files/format.h"

namespace affskel::client {

/// Where a command writes, from its options --output and --format.
/// @throws ClientError kUsage when the standard output is wanted for a result and for --json.
Destination destination_of(const std::string& output, const std::string& format, const Console& console);

}  // namespace affskel::client
