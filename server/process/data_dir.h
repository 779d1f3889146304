#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace affskel::server {

/// Another process holds the data directory.
class DataDirInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The process that holds a data directory, as a message calls it ("pid 123"); nothing when none does.
/// Changes nothing there.
std::optional<std::string> data_dir_holder(const std::string& path);

/// The data directory, held by this process alone: server.lock is locked as long as the object lives.
class DataDir {
 public:
  /// Makes the directory (mode 0700) when it is absent, and locks it.
  /// @param patience how long another server may hold it: one that is about to leave does so in a moment.
  /// @throws DataDirInUse when another server holds it; std::runtime_error when it is not usable, naming it.
  explicit DataDir(const std::string& path, std::chrono::milliseconds patience = std::chrono::seconds(3));
  ~DataDir();
  DataDir(const DataDir&) = delete;
  DataDir& operator=(const DataDir&) = delete;

  /// Absolute path.
  const std::string& path() const { return path_; }

  /// Whether the directory was deleted, moved or replaced by another one since it was locked.
  bool lost() const;

  /// Writes server.json, atomically: {"pid", "version", "started_ms", "addresses"}, and "metrics" if they are
  /// told.
  void publish(const std::vector<std::string>& addresses, const std::optional<std::string>& metrics,
               std::int64_t started_ms) const;

  /// Removes server.json.
  void withdraw() const;

 private:
  std::string path_;
  int lock_ = -1;
};

}  // namespace affskel::server
