#include "client/commands/shared/written.h"

#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/commands/shared/notices.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

std::string volume_text(const Fetched& fetched) {
  if (!fetched.volume) return "";
  // Counting points tells three digits at best; what a surface encloses is known as exactly as its vertices.
  return fetched.unit == "point" ? ", volume about " + base::plain(*fetched.volume, 3)
                                 : ", volume " + base::plain(*fetched.volume, base::kMeasureDigits);
}

nlohmann::ordered_json json_of(const Fetched& fetched) {
  nlohmann::ordered_json document = {{"job", fetched.job.id()},
                                     {"artefact", fetched.artifact},
                                     {"file", fetched.destination.file.string()},
                                     {fetched.unit + "s", fetched.items}};
  if (fetched.segments) document["segments"] = *fetched.segments;
  if (fetched.volume) document["volume"] = *fetched.volume;
  if (fetched.quality) document["quality"] = to_json(*fetched.quality);
  return document;
}

}  // namespace

void show_result(Console& console, const Fetched& fetched) {
  say(console, fetched.notices);
  show_written(console, fetched);
  console.document(json_of(fetched));
}

void show_written(Console& console, const Fetched& fetched) {
  console.note("wrote " + fetched.destination.name() + " (" + fetched.artifact + ", " +
               base::counted(fetched.items, fetched.unit) +
               (fetched.segments.value_or(0) > 0
                    ? ", " + base::counted(*fetched.segments, "segment") + " of curves"
                    : "") +
               volume_text(fetched) + ")");
}

}  // namespace affskel::client
