#include "client/text/words.h"

#include <google/protobuf/descriptor.h>

#include "client/base/error.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

using google::protobuf::EnumDescriptor;

std::string word_of(const EnumDescriptor& type, int number) {
  const auto* value = type.FindValueByNumber(number);
  const std::string word = value == nullptr ? "" : enum_word(*value);
  return word.empty() ? "unknown" : word;
}

std::vector<std::string> words_of(const EnumDescriptor& type) {
  std::vector<std::string> words;
  for (int i = 0; i < type.value_count(); ++i) {
    if (type.value(i)->number() != 0) words.push_back(enum_word(*type.value(i)));
  }
  return words;
}

int number_named(const EnumDescriptor& type, const std::string& what, const std::string& word) {
  std::string possible;
  for (int i = 0; i < type.value_count(); ++i) {
    const std::string known = enum_word(*type.value(i));
    if (known.empty()) continue;
    if (known == word) return type.value(i)->number();
    possible += (possible.empty() ? "" : ", ") + known;
  }
  throw ClientError(ExitCode::kUsage, "no " + what + " '" + word + "'; possible are " + possible);
}

}  // namespace

std::string state_word(v1::JobState state) {
  return word_of(*v1::JobState_descriptor(), state);
}

std::string stage_word(v1::JobStage stage) {
  return word_of(*v1::JobStage_descriptor(), stage);
}

std::string frame_word(v1::Frame frame) {
  return word_of(*v1::Frame_descriptor(), frame == v1::FRAME_UNSPECIFIED ? v1::FRAME_AXIS : frame);
}

std::string operator_word(v1::Operator which) {
  return word_of(*v1::Operator_descriptor(),
                 which == v1::OPERATOR_UNSPECIFIED ? v1::OPERATOR_ZUCKER_HUMMEL : which);
}

std::vector<std::string> state_words() {
  return words_of(*v1::JobState_descriptor());
}

std::vector<std::string> frame_words() {
  return words_of(*v1::Frame_descriptor());
}

std::vector<std::string> operator_words() {
  return words_of(*v1::Operator_descriptor());
}

v1::JobState state_named(const std::string& word) {
  return static_cast<v1::JobState>(number_named(*v1::JobState_descriptor(), "job state", word));
}

v1::Frame frame_named(const std::string& word) {
  return static_cast<v1::Frame>(number_named(*v1::Frame_descriptor(), "frame", word));
}

v1::Operator operator_named(const std::string& word) {
  return static_cast<v1::Operator>(number_named(*v1::Operator_descriptor(), "operator", word));
}

}  // namespace affskel::client
