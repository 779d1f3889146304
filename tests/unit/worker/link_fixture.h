#pragma once

#include <gtest/gtest.h>
#include <spdlog/logger.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <sstream>
#include <stop_token>
#include <string>
#include <vector>

#include "fake_server.h"
#include "job/prepared_job.h"
#include "link/last_report.h"
#include "link/server_link.h"
#include "sample_job.h"

namespace affskel::worker {

/// A fake server and the sample job, prepared, for what talks to a server about it.
class LinkTest : public testing::Test {
 protected:
  ServerLink link(std::chrono::seconds patience = std::chrono::seconds(20)) {
    return ServerLink({server_.address(), patience}, stop_.get_token());
  }

  FakeServer server_;
  std::stop_source stop_;
  PreparedJob prepared_{sample_mesh(), sample_params()};
  LastReport last_{[](const std::string&, const std::exception_ptr&) { ADD_FAILURE() << "a report failed"; }};
};

/// Takes what is logged while it lives.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  std::string text() const { return lines_.str(); }

 private:
  std::ostringstream lines_;
  std::shared_ptr<spdlog::logger> before_;
};

/// The field's bytes after the reports, merged as the server does; expects every report to count its records.
std::string merged(const PreparedJob& prepared, const std::vector<FakeServer::Report>& reports);

/// All positions that the reports call done, ascending, repeats included.
std::vector<std::uint64_t> positions(const std::vector<FakeServer::Report>& reports);

}  // namespace affskel::worker
