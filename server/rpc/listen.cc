#include "rpc/listen.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace affskel::server {
namespace {

[[noreturn]] void refuse(const wire::Address& address, const std::string& why) {
  throw std::runtime_error("cannot listen on " + address.target() + ": " + why);
}

void prepare_socket(const wire::Address& address) {
  struct stat status {};
  if (lstat(address.path.c_str(), &status) != 0) {
    if (errno == ENOENT) return;
    refuse(address, std::strerror(errno));
  }
  if (!S_ISSOCK(status.st_mode)) refuse(address, "the file exists and is not a socket");
  if (socket_answers(address.path)) refuse(address, "another server answers there");
  if (unlink(address.path.c_str()) != 0)
    refuse(address, std::string("stale socket: ") + std::strerror(errno));
}

}  // namespace

bool socket_answers(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.size() >= sizeof name.sun_path) return false;
  std::memcpy(name.sun_path, path.data(), path.size());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) throw std::runtime_error(std::string("socket: ") + std::strerror(errno));
  const int result = connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
  // EAGAIN: a live server whose queue is full.
  const bool answers = result == 0 || errno == EAGAIN || errno == EINPROGRESS;
  close(fd);
  return answers;
}

void prepare_addresses(const std::vector<wire::Address>& addresses) {
  for (const wire::Address& address : addresses) {
    if (!address.is_local()) {
      refuse(address, "this version serves only this machine: unix:PATH, localhost, 127.x.y.z or [::1]");
    }
    if (address.is_unix) prepare_socket(address);
  }
}

}  // namespace affskel::server
