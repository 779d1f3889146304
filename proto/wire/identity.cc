#include "wire/identity.h"

#include <unistd.h>

#include <array>

#include "base/random.h"

namespace affskel::wire {

std::string random_id() {
  return base::random_hex(16);
}

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "localhost";
  return name.data();
}

}  // namespace affskel::wire
