#include "client/text/words.h"

#include "client/base/error.h"
#include "wire/params.h"
#include "wire/words.h"

namespace affskel::client {
namespace {

template <typename Enum>
std::string word_or_unknown(Enum value) {
  const std::string word = wire::word(value);
  return word.empty() ? "unknown" : word;
}

template <typename Enum>
Enum named(const std::string& what, const std::string& word) {
  if (const std::optional<Enum> value = wire::value_of_word<Enum>(word)) return *value;
  std::string possible;
  for (const std::string& known : wire::words(*google::protobuf::GetEnumDescriptor<Enum>())) {
    possible += (possible.empty() ? "" : ", ") + known;
  }
  throw ClientError(ExitCode::kUsage, "no " + what + " '" + word + "'; possible are " + possible);
}

}  // namespace

std::string state_word(v1::JobState state) {
  return word_or_unknown(state);
}

std::string stage_word(v1::JobStage stage) {
  return word_or_unknown(stage);
}

std::string frame_word(v1::Frame frame) {
  return word_or_unknown(frame == v1::FRAME_UNSPECIFIED ? v1::FRAME_AXIS : frame);
}

std::string minimum_word(v1::Minimum minimum) {
  return word_or_unknown(minimum == v1::MINIMUM_UNSPECIFIED ? v1::MINIMUM_SET : minimum);
}

std::string operator_word(v1::Operator which) {
  return word_or_unknown(which == v1::OPERATOR_UNSPECIFIED ? wire::kDefaultOperator : which);
}

std::string severity_word(const v1::RepairStep& step) {
  return step.severity() == "warning" ? "warning" : "repaired";
}

std::string part_kind_word(v1::PartKind kind) {
  return word_or_unknown(kind);
}

std::vector<std::string> state_words() {
  return wire::words(*v1::JobState_descriptor());
}

std::vector<std::string> frame_words() {
  return wire::words(*v1::Frame_descriptor());
}

std::vector<std::string> minimum_words() {
  return wire::words(*v1::Minimum_descriptor());
}

std::vector<std::string> operator_words() {
  return wire::words(*v1::Operator_descriptor());
}

v1::JobState state_named(const std::string& word) {
  return named<v1::JobState>("job state", word);
}

v1::Frame frame_named(const std::string& word) {
  return named<v1::Frame>("frame", word);
}

v1::Minimum minimum_named(const std::string& word) {
  return named<v1::Minimum>("minimum", word);
}

v1::Operator operator_named(const std::string& word) {
  return named<v1::Operator>("operator", word);
}

}  // namespace affskel::client
