#pragma once

#include <CLI/App.hpp>

#include "client/operations/skeleton_choice.h"

namespace affskel::client {

/// --operator and --threshold.  Without a name of an operator in `skeleton` the default is the job's.
void add_skeleton_options(CLI::App* command, SkeletonChoice& skeleton);

}  // namespace affskel::client
