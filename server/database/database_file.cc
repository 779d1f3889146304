#include "database/database_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "errors.h"

namespace affskel::server {

std::string existing_database_file(const std::string& data_dir) {
  std::string file = database_file(data_dir);
  struct stat status {};
  if (stat(file.c_str(), &status) == 0) {
    // SQLite would take it for a new database, and delete the log beside it as left over.
    if (S_ISREG(status.st_mode) && status.st_size == 0)
      throw StoreError(StoreError::Code::kUnusable, file + ": no database, the file is empty");
    return file;
  }
  if (errno == ENOENT || errno == ENOTDIR) {
    throw StoreError(StoreError::Code::kUnusable,
                     data_dir + ": no data directory of affskel-server, " + "there is no affskel.db in it");
  }
  throw std::system_error(errno, std::generic_category(), file);
}

}  // namespace affskel::server
