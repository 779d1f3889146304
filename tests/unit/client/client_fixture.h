#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/commands/run_client.h"
#include "fake_service.h"
#include "tools/temporary_directory.h"

namespace affskel::client {

/// A job of 12 directions in that state; done: 5 points, 2 of them of the skeleton.
v1::Job sample_job(v1::JobState state);

struct Outcome {
  int exit_code = 0;
  std::string out, err;
};

/// The client from its arguments to its exit code, with a home of its own; it soon loses patience with
/// servers.
Outcome run_client_in(const tests::TemporaryDirectory& home, const std::vector<std::string>& arguments);

/// The client against a server in this process that holds one done job
/// with every artefact.  Files: cube.off, bad.off (a number is missing), open.off.
class ClientTest : public ::testing::Test {
 protected:
  ClientTest();

  Outcome run(std::vector<std::string> arguments, const std::string& address = "");

  tests::TemporaryDirectory dir_;
  FakeService service_;
  FakeServer server_;
  std::string mesh_;
};

}  // namespace affskel::client
