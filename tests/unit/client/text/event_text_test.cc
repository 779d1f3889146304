#include "client/text/event_text.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

v1::JobEvent& add(v1::ListJobEventsResponse& response, std::uint64_t number, const std::string& event) {
  v1::JobEvent& added = *response.add_events();
  added.set_number(number);
  added.set_time_ms(1'700'000'000'123);
  added.set_event(event);
  return added;
}

TEST(EventTextTest, ALineForEachEvent) {
  v1::ListJobEventsResponse response;
  add(response, 1, "submitted").set_message("mesh of 5 bytes");
  v1::JobEvent& leased = add(response, 2, "leased");
  leased.set_task(12);
  leased.set_kind("erode");
  leased.set_worker("0123456789abcdef");
  leased.set_message("positions 0 .. 63");
  add(response, 3, "done");
  EXPECT_EQ(
      event_lines(response),
      "2023-11-14 22:13:20.123Z  submitted         mesh of 5 bytes\n"
      "2023-11-14 22:13:20.123Z  leased            task 12 (erode), worker 0123456789ab, positions 0 .. 63\n"
      "2023-11-14 22:13:20.123Z  done\n");
}

TEST(EventTextTest, SaysWhereEventsWereLeftOut) {
  v1::ListJobEventsResponse response;
  add(response, 1, "submitted");
  add(response, 44, "done");
  EXPECT_EQ(event_lines(response),
            "2023-11-14 22:13:20.123Z  submitted\n... 42 events left out\n2023-11-14 22:13:20.123Z  done\n");
  EXPECT_EQ(event_lines({}), "");
}

// Directions count for one of those that told of them; the others' values are in the field all the same.
TEST(EventTextTest, AGiverOfNothingButWhatOthersGaveIsNamed) {
  v1::ListJobEventsResponse response;
  const auto add = [&response](const std::string& worker, std::uint64_t directions, std::uint64_t points) {
    v1::Giver& giver = *response.add_givers();
    giver.set_worker(worker);
    giver.set_directions(directions);
    giver.set_points(points);
  };
  add("a", 1, 2);
  add("b", 0, 0);
  add("c", 0, 3);
  EXPECT_EQ(event_lines(response),
            "given by a: 1 direction, 2 refined values\ngiven by b: of directions that others told of, too\n"
            "given by c: 3 refined values\n");
}

TEST(EventTextTest, AMessageIsOneLineAndDrivesNoTerminal) {
  v1::ListJobEventsResponse response;
  add(response, 1, "failed").set_message("BAD_INPUT: line 3\n\x1b[31mred");
  const std::string text = event_lines(response);
  EXPECT_EQ(text.find('\n'), text.size() - 1) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace affskel::client
