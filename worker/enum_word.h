#pragma once

#include <string>
#include <string_view>

namespace affskel::worker {

/// The word that people, the command line and the core have for a value of an enum of the protocol:
/// "zucker-hummel" for OPERATOR_ZUCKER_HUMMEL.
/// @param value_name as protobuf gives it; empty for a value that this program does not know.
/// @param prefix what all of the enum's values begin with, "OPERATOR_".
std::string enum_word(std::string_view value_name, std::string_view prefix);

}  // namespace affskel::worker
