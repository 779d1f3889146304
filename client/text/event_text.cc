#include "client/text/event_text.h"

#include "base/number_text.h"
#include "client/text/printable.h"
#include "client/text/time_text.h"

namespace affskel::client {
namespace {

constexpr std::size_t kShortWorkerName = 12;

// Longer than most: what follows stands in a column.
constexpr std::size_t kEventWidth = 16;

std::string event_line(const v1::JobEvent& event) {
  std::string line = utc_time(event.time_ms()) + "  " + one_line(event.event());
  std::string rest;
  const auto add = [&rest](const std::string& text) { rest += (rest.empty() ? "" : ", ") + one_line(text); };
  if (event.task() != 0) add("task " + std::to_string(event.task()) + " (" + event.kind() + ")");
  if (!event.worker().empty()) add("worker " + event.worker().substr(0, kShortWorkerName));
  if (!event.message().empty()) add(event.message());
  if (!rest.empty()) {
    line.append(event.event().size() < kEventWidth ? kEventWidth - event.event().size() : 0, ' ');
    line += "  " + rest;
  }
  return line + "\n";
}

}  // namespace

std::string event_lines(const v1::ListJobEventsResponse& response) {
  std::string text;
  std::uint64_t next = 1;
  for (const v1::JobEvent& event : response.events()) {
    if (event.number() > next) text += "... " + base::counted(event.number() - next, "event") + " left out\n";
    text += event_line(event);
    next = event.number() + 1;
  }
  for (const v1::Giver& giver : response.givers()) {
    std::string what;
    if (giver.directions() > 0) what = base::counted(giver.directions(), "direction");
    if (giver.points() > 0)
      what += (what.empty() ? "" : ", ") + base::counted(giver.points(), "refined value");
    text += "given by " + one_line(giver.worker()) +
            (giver.host().empty() ? "" : " on " + one_line(giver.host())) + ": " +
            (what.empty() ? "of directions that others told of, too" : what) + "\n";
  }
  return text;
}

}  // namespace affskel::client
