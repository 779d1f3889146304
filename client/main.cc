#include <unistd.h>

#include <cstdlib>
#include <iostream>

#include "base/standard_streams.h"
#include "client/cli/interrupt.h"
#include "client/commands/run_client.h"

namespace {

[[gnu::section(".preinit_array"),
  gnu::used]] void (*const at_first)(int, char**, char**) = affskel::base::keep_standard_streams;

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
