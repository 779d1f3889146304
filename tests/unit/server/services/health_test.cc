#include <grpcpp/generic/generic_stub.h>

#include <future>

#include "service_fixture.h"

namespace affskel::server {
namespace {

/// Answer of the health service: 1 = serving; status of the call when that is not OK.
int health_of(const std::shared_ptr<grpc::Channel>& channel, const std::string& service) {
  grpc::GenericStub stub(channel);
  const std::string bytes =
      service.empty() ? "" : '\n' + std::string(1, static_cast<char>(service.size())) + service;
  const grpc::Slice slice(bytes);
  grpc::ByteBuffer request(&slice, 1), response;
  grpc::ClientContext context;
  std::promise<grpc::Status> done;
  stub.UnaryCall(&context, "/grpc.health.v1.Health/Check", grpc::StubOptions(), &request, &response,
                 [&](const grpc::Status& status) { done.set_value(status); });
  if (const grpc::Status status = done.get_future().get(); !status.ok()) return -status.error_code();
  grpc::Slice answer;
  EXPECT_TRUE(response.TrySingleSlice(&answer).ok());
  return answer.size() == 2 ? answer.begin()[1] : 0;
}

TEST_F(ServiceTest, HealthIsToldOfEveryService) {
  for (const char* service : {"", "affskel.v1.ErosionService", "affskel.v1.WorkerService"}) {
    EXPECT_EQ(health_of(connect(), service), 1) << service;
  }
  EXPECT_EQ(health_of(connect(), "none"), -grpc::StatusCode::NOT_FOUND);
  server_->drain();
  EXPECT_EQ(health_of(connect(), "affskel.v1.ErosionService"), 2) << "not serving";
}

}  // namespace
}  // namespace affskel::server
