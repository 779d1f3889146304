#include "client/connection/health.h"

#include <google/protobuf/unknown_field_set.h>
#include <grpcpp/generic/generic_stub.h>

#include <cstdint>
#include <future>
#include <string>
#include <vector>

namespace affskel::client {
namespace {

constexpr const char* kCheck = "/grpc.health.v1.Health/Check";

// Of HealthCheckResponse: its one field, `status`, and the value SERVING.
constexpr int kStatusField = 1;
constexpr std::uint64_t kServing = 1;

std::string bytes_of(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  std::string bytes;
  if (!buffer.Dump(&slices).ok()) return bytes;
  for (const grpc::Slice& slice : slices) {
    bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  return bytes;
}

// The messages are a field each, so they are read as fields: no Debian package has the generated classes.
bool tells_serving(const grpc::ByteBuffer& response) {
  google::protobuf::UnknownFieldSet fields;
  if (!fields.ParseFromString(bytes_of(response))) return false;
  for (int i = 0; i < fields.field_count(); ++i) {
    const google::protobuf::UnknownField& field = fields.field(i);
    if (field.number() == kStatusField && field.type() == google::protobuf::UnknownField::TYPE_VARINT) {
      return field.varint() == kServing;
    }
  }
  return false;
}

}  // namespace

grpc::Status check_health(const std::shared_ptr<grpc::Channel>& channel, std::chrono::milliseconds deadline,
                          bool& serving) {
  grpc::GenericStub stub(channel);
  const grpc::Slice everything;  // HealthCheckRequest without the name of a service: the whole server
  const grpc::ByteBuffer request(&everything, 1);
  grpc::ByteBuffer response;
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + deadline);
  std::promise<grpc::Status> end;
  stub.UnaryCall(&context, kCheck, grpc::StubOptions(), &request, &response,
                 [&end](const grpc::Status& status) { end.set_value(status); });
  const grpc::Status status = end.get_future().get();
  if (status.ok()) serving = tells_serving(response);
  return status;
}

}  // namespace affskel::client
