#include "client/text/message_json.h"
#include "wire/words.h"

#include <google/protobuf/descriptor.h>

namespace affskel::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using nlohmann::ordered_json;

ordered_json enum_json(const google::protobuf::EnumValueDescriptor& value) {
  const std::string word = wire::word(value);
  return word.empty() ? ordered_json(nullptr) : ordered_json(word);
}

ordered_json single(const Message& m, const Reflection& r, const FieldDescriptor& f) {
  switch (f.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return r.GetInt32(m, &f);
    case FieldDescriptor::CPPTYPE_INT64:
      return r.GetInt64(m, &f);
    case FieldDescriptor::CPPTYPE_UINT32:
      return r.GetUInt32(m, &f);
    case FieldDescriptor::CPPTYPE_UINT64:
      return r.GetUInt64(m, &f);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return r.GetDouble(m, &f);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return r.GetFloat(m, &f);
    case FieldDescriptor::CPPTYPE_BOOL:
      return r.GetBool(m, &f);
    case FieldDescriptor::CPPTYPE_STRING:
      return r.GetString(m, &f);
    case FieldDescriptor::CPPTYPE_ENUM:
      return enum_json(*r.GetEnum(m, &f));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return to_json(r.GetMessage(m, &f));
  }
  return nullptr;
}

ordered_json element(const Message& m, const Reflection& r, const FieldDescriptor& f, int i) {
  switch (f.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return r.GetRepeatedInt32(m, &f, i);
    case FieldDescriptor::CPPTYPE_INT64:
      return r.GetRepeatedInt64(m, &f, i);
    case FieldDescriptor::CPPTYPE_UINT32:
      return r.GetRepeatedUInt32(m, &f, i);
    case FieldDescriptor::CPPTYPE_UINT64:
      return r.GetRepeatedUInt64(m, &f, i);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return r.GetRepeatedDouble(m, &f, i);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return r.GetRepeatedFloat(m, &f, i);
    case FieldDescriptor::CPPTYPE_BOOL:
      return r.GetRepeatedBool(m, &f, i);
    case FieldDescriptor::CPPTYPE_STRING:
      return r.GetRepeatedString(m, &f, i);
    case FieldDescriptor::CPPTYPE_ENUM:
      return enum_json(*r.GetRepeatedEnum(m, &f, i));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return to_json(r.GetRepeatedMessage(m, &f, i));
  }
  return nullptr;
}

}  // namespace

ordered_json to_json(const Message& message) {
  ordered_json object = ordered_json::object();
  const Reflection& reflection = *message.GetReflection();
  const auto* descriptor = message.GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    if (field.is_repeated()) {
      ordered_json list = ordered_json::array();
      for (int e = 0; e < reflection.FieldSize(message, &field); ++e) {
        list.push_back(element(message, reflection, field, e));
      }
      object[field.name()] = std::move(list);
    } else if (!field.has_presence() || reflection.HasField(message, &field)) {
      object[field.name()] = single(message, reflection, field);
    }
  }
  return object;
}

}  // namespace affskel::client
