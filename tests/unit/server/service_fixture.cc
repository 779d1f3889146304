#include "service_fixture.h"

#include <algorithm>
#include <stdexcept>

#include "wire/address.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::server {

grpc::Status submit_mesh(v1::ErosionService::Stub& stub, const v1::SubmitJobHeader& header,
                         const std::string& mesh, v1::SubmitJobResponse* response) {
  grpc::ClientContext context;
  const auto writer = stub.SubmitJob(&context, response);
  v1::SubmitJobRequest message;
  *message.mutable_header() = header;
  writer->Write(message);
  for (std::size_t at = 0; at < mesh.size(); at += wire::kChunkBytes) {
    message.set_data(mesh.substr(at, wire::kChunkBytes));
    writer->Write(message);
  }
  writer->WritesDone();
  return writer->Finish();
}

Fetched fetch(v1::ErosionService::Stub& stub, const v1::FetchArtifactRequest& request,
              grpc::ClientContext* context) {
  grpc::ClientContext own;
  const auto reader = stub.FetchArtifact(context == nullptr ? &own : context, request);
  Fetched fetched;
  v1::FetchArtifactResponse message;
  while (reader->Read(&message)) {
    if (message.has_header()) {
      fetched.header = message.header();
    } else {
      fetched.data += message.data();
    }
  }
  fetched.status = reader->Finish();
  return fetched;
}

grpc::Status send_report(v1::WorkerService::Stub& stub, const v1::Lease& lease, std::uint64_t begin,
                         std::uint64_t end, bool block_done, v1::ReportResponse* response,
                         std::int64_t announced) {
  const v1::FieldRecords all = made_up_records(lease.job(), begin, end);
  grpc::ClientContext context;
  const auto writer = stub.ReportErosion(&context, response);
  v1::ReportErosionRequest message;
  v1::ReportErosionHeader& header = *message.mutable_header();
  header.set_token(lease.token());
  v1::PositionRange& range = *header.add_positions_done();
  range.set_begin(begin);
  range.set_end(end);
  header.set_block_done(block_done);
  header.set_records(static_cast<std::uint64_t>(announced >= 0 ? announced : all.point_size()));
  writer->Write(message);
  for (int first = 0; first < all.point_size(); first += wire::kRecordsPerMessage) {
    v1::FieldRecords& part = *message.mutable_records();
    part.Clear();
    for (int i = first; i < std::min(all.point_size(), first + wire::kRecordsPerMessage); ++i) {
      part.add_point(all.point(i));
      part.add_direction(all.direction(i));
      part.add_erosion(all.erosion(i));
      part.add_area(all.area(i));
    }
    writer->Write(message);
  }
  writer->WritesDone();
  return writer->Finish();
}

grpc::Status send_result(v1::WorkerService::Stub& stub, const v1::CompleteTaskHeader& header,
                         const std::string& data) {
  grpc::ClientContext context;
  v1::ReportResponse response;
  const auto writer = stub.CompleteTask(&context, &response);
  v1::CompleteTaskRequest message;
  *message.mutable_header() = header;
  writer->Write(message);
  for (std::size_t at = 0; at < data.size(); at += wire::kChunkBytes) {
    message.set_data(data.substr(at, wire::kChunkBytes));
    writer->Write(message);
  }
  writer->WritesDone();
  return writer->Finish();
}

FakeWorker::FakeWorker(std::shared_ptr<grpc::Channel> channel, const std::string& id, std::uint32_t points,
                       std::uint32_t directions)
    : stub_(v1::WorkerService::NewStub(std::move(channel))),
      identity_(worker_identity(id)),
      points_(points),
      directions_(directions),
      thread_([this] { run(); }) {}

FakeWorker::~FakeWorker() {
  stopping_ = true;
  thread_.join();
}

void FakeWorker::run() {
  while (!stopping_) {
    grpc::ClientContext context;
    v1::LeaseTaskRequest request;
    *request.mutable_worker() = identity_;
    request.set_wait_ms(50);
    v1::LeaseTaskResponse response;
    if (!stub_->LeaseTask(&context, request, &response).ok()) return;
    if (response.has_lease()) work(response.lease());
  }
}

void FakeWorker::work(const v1::Lease& lease) {
  if (lease.kind() == v1::TASK_KIND_PREPARE) {
    const PrepareResult result = prepare_result(lease.token(), points_, directions_);
    EXPECT_TRUE(send_result(*stub_, result.header, result.data).ok());
    return;
  }
  if (lease.kind() != v1::TASK_KIND_ERODE) {
    const std::string data = "skeleton";
    EXPECT_TRUE(send_result(*stub_, derive_header(lease.token(), data, 3), data).ok());
    return;
  }
  for (int i = 0; i < lease.positions_size(); ++i) {
    v1::ReportResponse response;
    const grpc::Status status =
        send_report(*stub_, lease, lease.positions(i).begin(), lease.positions(i).end(),
                    i + 1 == lease.positions_size(), &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
  }
}

ServiceTest::ServiceTest() {
  options_.data_dir = directory_.path().string();
  options_.listen = {wire::parse_address("unix:" + options_.data_dir + "/server.sock")};
  start();
}

void ServiceTest::start() {
  server_.reset();
  server_ = std::make_unique<Server>(options_);
  client_ = v1::ErosionService::NewStub(connect());
  worker_ = v1::WorkerService::NewStub(connect());
}

std::shared_ptr<grpc::Channel> ServiceTest::connect() const {
  grpc::ChannelArguments arguments;
  // A connection of its own: a restarted server is found at once, without the back-off of an older one.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(server_->addresses().front().target(), grpc::InsecureChannelCredentials(),
                                   arguments);
}

std::string ServiceTest::submit(const std::string& mesh, const std::string& name) {
  v1::SubmitJobResponse response;
  const grpc::Status status = submit_mesh(*client_, submit_header(mesh, name), mesh, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response.job().id();
}

v1::Job ServiceTest::job(const std::string& id) {
  grpc::ClientContext context;
  v1::GetJobRequest request;
  request.set_job(id);
  v1::Job job;
  const grpc::Status status = client_->GetJob(&context, request, &job);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return job;
}

v1::Job ServiceTest::watch(const std::string& id) {
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job(id);
  const auto reader = client_->WatchJob(&context, request);
  v1::Job last;
  for (v1::Job next; reader->Read(&next);) last = next;
  const grpc::Status status = reader->Finish();
  EXPECT_TRUE(status.ok()) << status.error_message();
  return last;
}

v1::LeaseTaskResponse ServiceTest::poll(std::uint32_t wait_ms, const std::string& worker) {
  grpc::ClientContext context;
  v1::LeaseTaskRequest request;
  *request.mutable_worker() = worker_identity(worker);
  request.set_wait_ms(wait_ms);
  v1::LeaseTaskResponse response;
  const grpc::Status status = worker_->LeaseTask(&context, request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response;
}

void ServiceTest::wait_for_workers(int count) {
  for (;;) {
    grpc::ClientContext context;
    v1::ServerInfo info;
    ASSERT_TRUE(client_->GetServerInfo(&context, {}, &info).ok());
    if (info.workers_size() >= count) return;
    std::this_thread::yield();
  }
}

}  // namespace affskel::server
