#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "access/token.h"
#include "database/database_file.h"
#include "service_fixture.h"
#include "wire/channel.h"

namespace affskel::server {

/// A server with a Unix socket, a TCP address on loopback, and tokens.
class AccessTest : public ServiceTest {
 protected:
  AccessTest() { options_.listen.push_back(wire::parse_address("127.0.0.1:0")); }

  /// Adds a token beside the running server, as affskel-server token add does; returns its id.
  std::int64_t add(const std::string& owner, v1::Role role, std::optional<std::int64_t> expires_ms = {}) {
    const std::string token = new_token();
    Database db(database_file(options_.data_dir), Database::Mode::kReadWrite);
    const std::int64_t id = add_token(db, token, owner, role, unix_ms(), expires_ms);
    spit("token." + owner, token + "\n");
    return id;
  }
  void revoke(std::int64_t id) {
    Database db(database_file(options_.data_dir), Database::Mode::kReadWrite);
    revoke_token(db, id, unix_ms());
  }
  void spit(const std::string& name, const std::string& text) {
    std::ofstream(directory_.path() / name) << text;
  }
  std::string file(const std::string& name) const { return (directory_.path() / name).string(); }

  /// The TCP address, with the token that was added for this owner; "" = with none.
  std::shared_ptr<grpc::Channel> tcp(const std::string& owner, wire::AccessFiles files = {}) {
    if (!owner.empty()) files.token_file = file("token." + owner);
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return wire::make_channel(server_->addresses().back(), files, arguments);
  }
  std::unique_ptr<v1::ErosionService::Stub> client(const std::string& owner) {
    return v1::ErosionService::NewStub(tcp(owner));
  }
  std::string submit_as(const std::string& owner, const std::string& mesh,
                        const std::string& request_id = "") {
    v1::SubmitJobHeader header = submit_header(mesh);
    header.set_request_id(request_id);
    v1::SubmitJobResponse response;
    const grpc::Status status = submit_mesh(*client(owner), header, mesh, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(response.job().owner(), owner);
    return response.job().id();
  }
  grpc::Status get(v1::ErosionService::Stub& stub, const std::string& job, v1::Job* response = nullptr) {
    grpc::ClientContext context;
    v1::GetJobRequest request;
    request.set_job(job);
    v1::Job ignored;
    return stub.GetJob(&context, request, response != nullptr ? response : &ignored);
  }
  grpc::Status info(v1::ErosionService::Stub& stub, v1::ServerInfo* response) {
    grpc::ClientContext context;
    return stub.GetServerInfo(&context, {}, response);
  }
};

}  // namespace affskel::server
