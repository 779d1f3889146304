#pragma once

#include <filesystem>

namespace affskel::base {

/// That a file lies in; "." for a name alone.
std::filesystem::path directory_of(const std::filesystem::path& file);

/// Puts on the disk which files a directory has.  Not every file system can; the files themselves are safe there.
void sync_directory(const std::filesystem::path& directory);

}  // namespace affskel::base
