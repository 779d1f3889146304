#include "base/regular_file.h"

#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>

namespace affskel::base {
namespace {

bool is_unnamed_pipe(const std::string& path) {
  struct statfs status {};
  return statfs(path.c_str(), &status) == 0 && status.f_type == PIPEFS_MAGIC;
}

}  // namespace

const char* kind_unless_regular(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return nullptr;
  switch (status.st_mode & S_IFMT) {
    case S_IFREG:
      return nullptr;
    case S_IFIFO:
      return is_unnamed_pipe(path) ? nullptr : "a FIFO";
    case S_IFDIR:
      return "a directory";
    case S_IFSOCK:
      return "a socket";
    default:
      return "a device";
  }
}

}  // namespace affskel::base
