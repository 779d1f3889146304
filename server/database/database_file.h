#pragma once

#include <cstdint>
#include <string>

namespace affskel::server {

/// The database of a data directory.
inline std::string database_file(const std::string& data_dir) {
  return data_dir + "/affskel.db";
}

/// The same, where there must be one already.
/// @throws StoreError kUnusable when there is none, it is empty, or it or its log is no regular file;
///   std::system_error when that cannot be told.
std::string existing_database_file(const std::string& data_dir);

/// Makes sure that `file` is a database that a server may open.  A new one is made beside it and appears
/// complete.  A mark (affskel.made) then says that there is one, so that a database which is missing or empty
/// later on is never taken for a new directory.
/// @returns file.
/// @throws StoreError kUnusable when it is missing where the mark or a log is, empty, foreign, or no regular
///   file, nor its log; what Database throws.
const std::string& ready_database_file(const std::string& file);

/// What tells a file from a copy of it: its number in the file system and, where that is known, the time of
/// its birth.  Empty when the file is not there.
std::string file_identity(const std::string& file);

/// The database file and its log, as they were when this was made.
class OpenFile {
 public:
  OpenFile() = default;
  explicit OpenFile(const std::string& database);

  /// Whether one of them was removed or replaced since: what is written now is lost.
  bool replaced() const;

 private:
  struct Seen {
    std::string path;
    std::uint64_t device = 0;
    std::uint64_t number = 0;  // 0: it was not there
  };
  static Seen see(const std::string& path);

  Seen database_;
  Seen log_;
};

}  // namespace affskel::server
