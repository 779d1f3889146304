#pragma once

#include <string>

namespace affskel::base {

/// A file to remove if a signal ends the process before `release_temporary_file` of the same path.  At most 8
/// at a time; further ones are not guarded.  Thread-safe.
void guard_temporary_file(const std::string& path);
void release_temporary_file(const std::string& path);

/// Removes all that are guarded.  For handlers of signals that end the process.
void remove_guarded_files() noexcept;

}  // namespace affskel::base
