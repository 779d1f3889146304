#include "client/base/stance.h"

#include "client/base/error.h"

namespace affskel::client {
namespace {

using core::AxisDirection;

std::optional<AxisDirection> direction_named(std::string_view text) {
  const bool minus = text.starts_with('-');
  if (minus || text.starts_with('+')) text.remove_prefix(1);
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return std::nullopt;
  return AxisDirection{static_cast<std::size_t>(text[0] - 'x'), minus};
}

v1::AxisDirection message_of(const AxisDirection& direction) {
  return static_cast<v1::AxisDirection>(v1::AXIS_DIRECTION_X + 2 * static_cast<int>(direction.axis) +
                                        (direction.minus ? 1 : 0));
}

AxisDirection direction_of(v1::AxisDirection message) {
  const int number = message - v1::AXIS_DIRECTION_X;
  return {static_cast<std::size_t>(number / 2), number % 2 == 1};
}

}  // namespace

StanceChoice parse_stance(std::string_view text) {
  StanceChoice choice;
  if (text == "shape") {
    choice.by_shape = true;
    return choice;
  }
  const std::size_t comma = text.find(',');
  choice.up = direction_named(text.substr(0, comma));
  if (comma != std::string_view::npos) choice.front = direction_named(text.substr(comma + 1));
  if (!choice.up || (comma != std::string_view::npos && !choice.front)) {
    throw ClientError(ExitCode::kUsage,
                      "'" + std::string(text) +
                          "' is no stance: UP or UP,FRONT is needed, each x, -x, y, -y, z or -z, "
                          "such as z,-y; or shape");
  }
  if (choice.front && choice.front->axis == choice.up->axis) {
    throw ClientError(ExitCode::kUsage, "'" + std::string(text) +
                                            "': what is up and what is in front lie along different axes");
  }
  return choice;
}

std::string direction_text(const AxisDirection& direction) {
  return (direction.minus ? "-" : "") + std::string(1, static_cast<char>('x' + direction.axis));
}

std::string stance_text(const core::Stance& stance) {
  return direction_text(stance.up) + " up, facing " + direction_text(stance.front);
}

std::optional<core::Stance> kept_stance(const v1::Job& job) {
  const v1::Stance& kept = job.stance();
  if (kept.up() == v1::AXIS_DIRECTION_UNSPECIFIED) return std::nullopt;
  return core::Stance{direction_of(kept.up()), direction_of(kept.front())};
}

v1::Stance stance_message(const core::Stance& stance) {
  v1::Stance message;
  message.set_up(message_of(stance.up));
  message.set_front(message_of(stance.front));
  return message;
}

core::Stance stance_of(const StanceChoice& choice, const v1::Job& job, const core::Mesh& mesh) {
  if (choice.up && choice.front) return {*choice.up, *choice.front};
  if (choice.up) return core::find_stance(mesh, choice.up);
  if (const auto kept = kept_stance(job); kept && !choice.by_shape) return *kept;
  return core::find_stance(mesh);
}

}  // namespace affskel::client
