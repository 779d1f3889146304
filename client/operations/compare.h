#pragma once

#include <string>

#include "client/comparison/comparison.h"

namespace affskel::client {

/// What is compared, and which files are made of it.
struct CompareRequest {
  ComparisonOptions comparison;
  std::string plot;   ///< .svg, or "-", standard output; empty = none
  std::string table;  ///< .csv, or "-"; empty = none
};

/// Compares, and writes the files that are asked for: all of them or none appear.
/// @throws ClientError as compare_files; kUsage, before the work is done, for another extension or a file
/// that cannot be made.
Comparison compare(const CompareRequest& request, const FileWork& work);

}  // namespace affskel::client
