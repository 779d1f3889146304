#include "client/web/random_key.h"

#include <cerrno>
#include <stdexcept>

#include "base/random.h"
#include "client/base/error.h"

namespace affskel::client {

std::string random_key() {
  try {
    return base::random_hex(32);
  } catch (const std::runtime_error&) {
    throw error_from_errno(errno, "cannot get random bytes", "", ExitCode::kInternal);
  }
}

}  // namespace affskel::client
