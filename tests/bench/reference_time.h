#pragma once

#include <optional>
#include <string>

#include "result.h"
#include "rows.h"

namespace affskel::bench {

/// Times the published program (tests/reference/published_program.h) on a row's mesh with the row's spacing
/// as dT and dD, on triangles spread evenly over the mesh until about `budget_s` processor seconds are used
/// up, and scales to all triangles.  Nothing for rows without a spacing of their own, and for more than 500
/// triangles, where a sample worth the name would take minutes.
/// @throws CoreError and std::runtime_error when the file cannot be read.
std::optional<ReferenceTime> run_reference(const RowSpec& row, const std::string& off_file, double budget_s);

}  // namespace affskel::bench
