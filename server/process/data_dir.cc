#include "process/data_dir.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "base/regular_file.h"
#include "wire/version.h"

namespace affskel::server {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error("data directory " + path + ": " + why);
}

/// With the system's reason, by which the caller tells what may pass by itself.
[[noreturn]] void refuse(const std::string& path, const char* what, int error) {
  throw std::system_error(error, std::generic_category(), "data directory " + path + what);
}

std::string make_directory(const std::string& path) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  if (error) refuse(path, error.message());
  if (absolute.has_parent_path()) std::filesystem::create_directories(absolute.parent_path(), error);
  if (mkdir(absolute.c_str(), 0700) != 0 && errno != EEXIST) refuse(path, "", errno);
  if (!std::filesystem::is_directory(absolute, error)) refuse(path, "not a directory");
  return absolute.lexically_normal().string();
}

std::string read_pid(int fd) {
  std::array<char, 32> text{};
  const ssize_t size = pread(fd, text.data(), text.size() - 1, 0);
  return "pid " + (size > 0 ? std::string(text.data(), std::strcspn(text.data(), "\n")) : "unknown");
}

// False with errno set when it cannot be locked in time.
bool lock_within(int fd, std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds kPause(20);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK || std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

}  // namespace

std::optional<std::string> data_dir_holder(const std::string& path) {
  const int fd = open((path + "/server.lock").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return std::nullopt;
  // Shared, so that two processes that ask at once do not take each other for a server; given back with the
  // descriptor. A server that starts in between waits a little longer than that.
  const bool held = flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  const std::string holder = read_pid(fd);
  close(fd);
  return held ? std::optional(holder) : std::nullopt;
}

DataDir::DataDir(const std::string& path, std::chrono::milliseconds patience) : path_(make_directory(path)) {
  const std::string file = path_ + "/server.lock";
  if (const char* kind = base::kind_unless_regular(file)) {
    refuse(path_, std::string("server.lock is ") + kind + ", not a regular file");
  }
  lock_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock_ < 0) refuse(path_, ": server.lock", errno);
  if (!lock_within(lock_, patience)) {
    const int error = errno;
    const std::string holder = read_pid(lock_);
    close(lock_);
    if (error != EWOULDBLOCK) refuse(path_, ": server.lock", error);
    throw DataDirInUse("data directory " + path_ + ": another affskel-server uses it (" + holder + ")");
  }
  // For people and for the message above only; the lock itself is what counts.
  const std::string pid = std::to_string(getpid()) + "\n";
  const bool told = ftruncate(lock_, 0) == 0 && pwrite(lock_, pid.data(), pid.size(), 0) >= 0;
  // On a full disk this must not keep the server from starting: it is what jobs are deleted with.
  if (!told && errno != ENOSPC && errno != EDQUOT) {
    const int error = errno;
    close(lock_);
    refuse(path_, ": server.lock", error);
  }
}

DataDir::~DataDir() {
  close(lock_);
}

bool DataDir::lost() const {
  struct stat held {};
  struct stat now {};
  if (fstat(lock_, &held) != 0) return true;
  if (stat((path_ + "/server.lock").c_str(), &now) != 0) return errno == ENOENT || errno == ENOTDIR;
  return held.st_dev != now.st_dev || held.st_ino != now.st_ino;
}

void DataDir::publish(const std::vector<std::string>& addresses, const std::optional<std::string>& metrics,
                      std::int64_t started_ms) const {
  nlohmann::json json = {
      {"pid", getpid()}, {"version", wire::kVersion}, {"started_ms", started_ms}, {"addresses", addresses}};
  if (metrics) json["metrics"] = *metrics;
  const std::string file = path_ + "/server.json";
  const std::string temporary = file + ".new";
  unlink(temporary.c_str());  // whatever it is
  std::ofstream out(temporary, std::ios::trunc);
  out << json.dump() << '\n';
  out.close();
  if (!out || rename(temporary.c_str(), file.c_str()) != 0) {
    refuse(path_, ": cannot write server.json", errno);
  }
}

void DataDir::withdraw() const {
  unlink((path_ + "/server.json").c_str());
}

}  // namespace affskel::server
