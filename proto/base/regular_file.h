#pragma once

#include <string>

namespace affskel::base {

/// What lies at a path that is no regular file, for messages: "a FIFO", "a directory".  To be asked before a
/// file is opened that should be one: opening a FIFO waits, perhaps for ever, for a process to open its other
/// end.
/// @returns nullptr for a regular file, for what is not there or cannot be looked at, and for a shell's
///   <(command), whose other end is open.
const char* kind_unless_regular(const std::string& path);

}  // namespace affskel::base
