#include "base/find_program.h"

#include <unistd.h>

#include <sstream>
#include <system_error>

namespace affskel::base {

namespace fs = std::filesystem;

bool is_program(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

fs::path own_directory() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

fs::path find_program(const std::string& name, const fs::path& beside, const std::string& search_path) {
  if (!beside.empty() && is_program(beside / name)) return beside / name;
  std::istringstream folders(search_path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (fs::path(folder).is_absolute() && is_program(fs::path(folder) / name)) return fs::path(folder) / name;
  }
  return {};
}

}  // namespace affskel::base
