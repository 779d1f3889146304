#pragma once

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "core/files/file_facts.h"

namespace affskel::client {

/// What every file made from a job says of itself.  @param what it holds, e.g. "affine skeleton".
core::FileFacts job_facts(const v1::Job& job, const std::string& what);

/// The facts as comments: a line each, the key and the text.
std::vector<std::string> comment_lines(const core::FileFacts& facts);

}  // namespace affskel::client
