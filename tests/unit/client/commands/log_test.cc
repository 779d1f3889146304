// The command log, against a server in this process.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "client_fixture.h"

namespace affskel::client {
namespace {

using nlohmann::json;

TEST_F(ClientTest, LogPrintsALineForEachEventAndAnObjectUnderJson) {
  v1::JobEvent& submitted = *service_.events.add_events();
  submitted.set_number(1);
  submitted.set_event("submitted");
  v1::JobEvent& leased = *service_.events.add_events();
  leased.set_number(2);
  leased.set_event("leased");
  leased.set_worker("w\n1");
  const Outcome outcome = run({"log", "@last"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
  std::istringstream lines(run({"--json", "log", "@last"}).out);
  std::vector<json> events;
  for (std::string line; std::getline(lines, line);) events.push_back(json::parse(line));
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].at("event"), "submitted");
  EXPECT_EQ(events[1].at("number"), 2);
  EXPECT_EQ(events[1].at("worker"), "w\n1");
  service_.fails = {grpc::StatusCode::NOT_FOUND, "no job begins with 000000"};
  EXPECT_EQ(run({"log", "000000"}).exit_code, 4);
}

}  // namespace
}  // namespace affskel::client
