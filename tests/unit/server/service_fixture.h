#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "affskel/v1/client_service.grpc.pb.h"
#include "affskel/v1/worker_service.grpc.pb.h"
#include "services/server.h"
#include "store_fixture.h"

namespace affskel::server {

/// Sends a mesh; returns the call's status.
grpc::Status submit_mesh(v1::ErosionService::Stub& stub, const v1::SubmitJobHeader& header,
                         const std::string& mesh, v1::SubmitJobResponse* response);

struct Fetched {
  grpc::Status status;
  v1::ArtifactHeader header;
  std::string data;
};
Fetched fetch(v1::ErosionService::Stub& stub, const v1::FetchArtifactRequest& request,
              grpc::ClientContext* context = nullptr);

/// One report of positions [begin, end) with all made-up records; `announced` instead of their number
/// when it is not negative.
grpc::Status send_report(v1::WorkerService::Stub& stub, const v1::Lease& lease, std::uint64_t begin,
                         std::uint64_t end, bool block_done, v1::ReportResponse* response,
                         std::int64_t announced = -1);

grpc::Status send_result(v1::WorkerService::Stub& stub, const v1::CompleteTaskHeader& header,
                         const std::string& data);

/// Does every task at once with made-up results, in a thread of its own.
class FakeWorker {
 public:
  FakeWorker(std::shared_ptr<grpc::Channel> channel, const std::string& id, std::uint32_t points,
             std::uint32_t directions);
  ~FakeWorker();

 private:
  void run();
  void work(const v1::Lease& lease);

  std::unique_ptr<v1::WorkerService::Stub> stub_;
  v1::WorkerIdentity identity_;
  std::uint32_t points_;
  std::uint32_t directions_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

/// A server on a Unix socket in a directory of its own.
class ServiceTest : public testing::Test {
 protected:
  ServiceTest();

  void start();
  std::shared_ptr<grpc::Channel> connect() const;
  std::string submit(const std::string& mesh = "OFF 1", const std::string& name = "body");
  v1::Job job(const std::string& id);
  /// Follows a job to the end of the stream; returns the last message.
  v1::Job watch(const std::string& id);
  v1::LeaseTaskResponse poll(std::uint32_t wait_ms, const std::string& worker = "worker-a");
  /// Until this many workers were heard from.
  void wait_for_workers(int count);

  TemporaryDirectory directory_;
  ServerOptions options_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<v1::ErosionService::Stub> client_;
  std::unique_ptr<v1::WorkerService::Stub> worker_;
};

}  // namespace affskel::server
