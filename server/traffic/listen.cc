#include "traffic/listen.h"

#include <sys/stat.h>
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
  if (wire::socket_answers(address.path)) refuse(address, "another server answers there");
  if (unlink(address.path.c_str()) != 0)
    refuse(address, std::string("stale socket: ") + std::strerror(errno));
}

}  // namespace

void prepare_addresses(const std::vector<wire::Address>& addresses) {
  for (const wire::Address& address : addresses) {
    if (address.is_unix) prepare_socket(address);
  }
}

void require_protection(const std::vector<wire::Address>& addresses, const Protection& protection) {
  if (protection.insecure) return;
  for (const wire::Address& address : addresses) {
    if (address.is_local()) continue;
    if (!protection.tls) {
      refuse(address,
             "other machines reach it, and there is no TLS: --tls-cert and --tls-key, or --insecure");
    }
    if (!protection.tokens) {
      refuse(address,
             "other machines reach it, and there is no token: affskel-server token add, or --insecure");
    }
  }
}

}  // namespace affskel::server
