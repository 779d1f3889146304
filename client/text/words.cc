#include "client/text/words.h"

#include <google/protobuf/descriptor.h>

#include "client/base/error.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

std::string or_unknown(const google::protobuf::EnumValueDescriptor* value) {
  const std::string word = value == nullptr ? "" : enum_word(*value);
  return word.empty() ? "unknown" : word;
}

}  // namespace

std::string frame_word(v1::Frame frame) {
  return frame == v1::FRAME_UNSPECIFIED ? "axis"
                                        : or_unknown(v1::Frame_descriptor()->FindValueByNumber(frame));
}

std::string state_word(v1::JobState state) {
  return or_unknown(v1::JobState_descriptor()->FindValueByNumber(state));
}

std::string stage_word(v1::JobStage stage) {
  return or_unknown(v1::JobStage_descriptor()->FindValueByNumber(stage));
}

const std::vector<std::string>& operator_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    const auto* type = v1::Operator_descriptor();
    for (int i = 0; i < type->value_count(); ++i) {
      if (type->value(i)->number() != 0) list.push_back(enum_word(*type->value(i)));
    }
    return list;
  }();
  return names;
}

v1::Operator operator_named(const std::string& name) {
  const auto* type = v1::Operator_descriptor();
  std::string possible;
  for (int i = 0; i < type->value_count(); ++i) {
    const std::string word = enum_word(*type->value(i));
    if (word.empty()) continue;
    if (word == name) return static_cast<v1::Operator>(type->value(i)->number());
    possible += (possible.empty() ? "" : ", ") + word;
  }
  throw ClientError(ExitCode::kUsage, "no operator '" + name + "'; possible are " + possible);
}

std::string operator_word(v1::Operator which) {
  const auto* value = v1::Operator_descriptor()->FindValueByNumber(which);
  return value == nullptr || value->number() == 0 ? "zucker-hummel" : enum_word(*value);
}

}  // namespace affskel::client
