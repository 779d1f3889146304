#include "client/commands/shared/written.h"

#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/commands/shared/follow.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

std::string volume_text(const Written& written) {
  if (!written.volume) return "";
  // Counting points tells three digits at best; what a surface encloses is known as exactly as its vertices.
  return written.unit == "point" ? ", volume about " + base::plain(*written.volume, 3)
                                 : ", volume " + base::plain(*written.volume, base::kMeasureDigits);
}

// A sheet comes with its quality, an alpha shape does not.
std::string advice_for_empty_surface(const Written& written) {
  if (!written.quality) {
    return "no three skeleton points are near enough; try a larger --alpha or a smaller --threshold";
  }
  const std::string& advice = written.quality->advice();
  return advice.empty() ? "no piece of the sheet is significant enough; try a smaller --threshold" : advice;
}

}  // namespace

void tell_result(Context& context, const Written& written) {
  Console& console = context.console();
  if (written.kind == "skeleton") {
    warn_about_skeleton(context, written.items, written.quality.value_or(v1::SkeletonQuality()), written.job);
  }
  if (written.kind == "surface" && written.items + written.segments == 0) {
    console.warning("the surface is empty: " + advice_for_empty_surface(written));
  }
  if (written.kind == "eroded" && written.items == 0) {
    console.warning("the eroded solid is empty: " +
                    (written.advice.empty() ? "no sample point has such an E" : written.advice) +
                    "; try a lower level");
  }
  tell_written(console, written);
  console.document(written_json(written));
}

nlohmann::ordered_json written_json(const Written& written) {
  nlohmann::ordered_json document = {{"job", written.job.id()},
                                     {"artefact", written.kind},
                                     {"file", written.destination.file.string()},
                                     {written.unit + "s", written.items}};
  if (written.kind == "surface") document["segments"] = written.segments;
  if (written.volume) document["volume"] = *written.volume;
  if (written.quality) document["quality"] = to_json(*written.quality);
  return document;
}

void tell_written(Console& console, const Written& written) {
  console.note(
      "wrote " + written.destination.name() + " (" + written.kind + ", " +
      base::counted(written.items, written.unit) +
      (written.segments > 0 ? ", " + base::counted(written.segments, "segment") + " of curves" : "") +
      volume_text(written) + ")");
}

}  // namespace affskel::client
