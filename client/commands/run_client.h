#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "client/connection/environment.h"
#include "client/connection/session.h"

namespace affskel::client {

/// What the process gives the client; replaceable in tests.
struct ClientIo {
  std::ostream& out;
  std::ostream& err;
  bool err_is_terminal = false;
  Environment environment;
  RetryPolicy retry;
  bool out_is_terminal = false;
};

/// Runs the client as if from the command line and returns the exit code.
/// @param arguments without the program's name.
int run_client(const std::vector<std::string>& arguments, const ClientIo& io);

}  // namespace affskel::client
