#pragma once

#include <CLI/App.hpp>

#include "client/operations/skeleton_choice.h"

namespace affskel::client {

/// --operator and --threshold.  Without a name of an operator in `skeleton` the default is the job's, or of
/// what is `shown` that of shown_skeleton().
void add_skeleton_options(CLI::App* command, SkeletonChoice& skeleton, bool shown = false);

}  // namespace affskel::client
