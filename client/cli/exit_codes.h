#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace affskel::client {

/// What the exit codes mean, for the help and the manual.
inline constexpr std::array<std::pair<int, std::string_view>, 11> kExitCodes = {
    {{0, "done"},
     {1, "the job failed"},
     {2, "usage"},
     {3, "bad input file"},
     {4, "no such job or artefact"},
     {5, "server unreachable"},
     {6, "cancelled"},
     {7, "not allowed"},
     {8, "limit reached"},
     {70, "internal error"},
     {141, "nobody reads the output any more"}}};

}  // namespace affskel::client
