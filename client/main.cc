#include <unistd.h>

#include <iostream>

#include "client/cli/interrupt.h"
#include "client/commands/run_client.h"

int main(int argc, char** argv) {
  using namespace affskel::client;
  install_interrupt_handlers();
  const ClientIo io{std::cout, std::cerr, isatty(STDERR_FILENO) == 1, process_environment(), {}};
  return run_client(std::vector<std::string>(argv + 1, argv + argc), io);
}
