#pragma once

#include <string>

namespace affskel::server {

/// The database of a data directory.
inline std::string database_file(const std::string& data_dir) {
  return data_dir + "/affskel.db";
}

/// The same, where there must be one already.
/// @throws StoreError kUnusable when there is none or it is empty; std::system_error when that cannot be
/// told.
std::string existing_database_file(const std::string& data_dir);

}  // namespace affskel::server
