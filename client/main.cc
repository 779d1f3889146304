#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>

#include "client/cli/interrupt.h"
#include "client/commands/run_client.h"

namespace {

// Where a standard stream is closed, the next file or connection would take its place and be written into.
// What reads the one or writes to the other fails as it would, but for notes on standard error.
void keep_standard_streams(int, char**, char**) {
  constexpr int kModes[] = {O_WRONLY, O_RDONLY, O_WRONLY};
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", kModes[fd]) != fd) std::abort();
  }
}

// Before the initialisers of libraries: gRPC's makes a descriptor.
[[gnu::section(".preinit_array"), gnu::used]] void (*const at_first)(int, char**,
                                                                     char**) = keep_standard_streams;

}  // namespace

int main(int argc, char** argv) {
  using namespace affskel::client;
  setenv("GRPC_VERBOSITY", "NONE", 0);  // what matters to people is told as errors
  install_interrupt_handlers();
  const ClientIo io{std::cout,
                    std::cerr,
                    isatty(STDERR_FILENO) == 1,
                    process_environment(),
                    {},
                    isatty(STDOUT_FILENO) == 1};
  return run_client(std::vector<std::string>(argv + 1, argv + argc), io);
}
