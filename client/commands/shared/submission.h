#pragma once

#include <cstdint>
#include <string>

#include "client/commands/shared/context.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/files/read/input_file.h"

namespace affskel::client {

/// What is asked of a mesh that is submitted.
struct Submission {
  double spacing = 0;  ///< mesh units; 0 = by points
  std::uint64_t points = 100000;
  std::string directions = "triangles";
  std::string frame = "axis";
  SkeletonOptions skeleton{"zucker-hummel"};
  std::string name;  ///< empty = the file's stem
  unsigned priority = 5;
  std::string request_id;
  bool repair = true;
};

/// Checks what a worker would refuse of lattice and directions, before anything is sent.
/// @throws ClientError kBadInput or kLimit.
void check_submission(const core::Solid& solid, const InputFile& input, const Submission& submission);

/// @throws ClientError kUsage when the protocol has no room for a text; kLimit when the server takes no file
/// as large.
v1::SubmitJobHeader submission_header(Context& context, const InputFile& input, const Submission& submission);

}  // namespace affskel::client
