#include "fake_server.h"

#include <algorithm>
#include <utility>

#include "wire/sha256.h"

namespace affskel::worker {

FakeServer::FakeServer() {
  grpc::ServerBuilder builder;
  builder.AddListeningPort(address(), grpc::InsecureServerCredentials());
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
  builder.RegisterService(this);
  server_ = builder.BuildAndStart();
}

FakeServer::~FakeServer() {
  server_->Shutdown();
}

std::string FakeServer::address() const {
  return "unix:" + dir_ / "s";
}

std::string FakeServer::tcp_address() const {
  return "127.0.0.1:" + std::to_string(port_);
}

void FakeServer::offer(const v1::Lease& lease) {
  const std::lock_guard<std::mutex> guard(mutex_);
  leases_.push_back(lease);
}

void FakeServer::set_input(v1::ArtifactKind kind, const std::string& bytes) {
  const std::lock_guard<std::mutex> guard(mutex_);
  inputs_.emplace_back(kind, bytes);
}

void FakeServer::fail_next(const std::string& method, const grpc::Status& status, int times) {
  const std::lock_guard<std::mutex> guard(mutex_);
  for (int i = 0; i < times; ++i) failures_to_come_.emplace_back(method, status);
}

void FakeServer::hold_next_fetch() {
  const std::lock_guard<std::mutex> guard(mutex_);
  hold_next_ = true;
}

void FakeServer::cancel_next_renewal() {
  const std::lock_guard<std::mutex> guard(mutex_);
  cancel_next_renewal_ = true;
}

bool FakeServer::take_hold() {
  const std::lock_guard<std::mutex> guard(mutex_);
  return std::exchange(hold_next_, false);
}

void FakeServer::damage_next_fetch() {
  const std::lock_guard<std::mutex> guard(mutex_);
  damage_next_ = true;
}

void FakeServer::on_report(std::function<v1::ReportResponse(const v1::ReportErosionHeader&)> answer) {
  const std::lock_guard<std::mutex> guard(mutex_);
  answer_ = std::move(answer);
}

std::vector<FakeServer::Report> FakeServer::reports() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return reports_;
}
std::vector<FakeServer::Completion> FakeServer::completions() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return completions_;
}
std::vector<v1::FailTaskRequest> FakeServer::failures() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return failures_;
}
std::vector<v1::LeaseTaskRequest> FakeServer::lease_requests() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return lease_requests_;
}

int FakeServer::calls(const std::string& method) const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return static_cast<int>(std::count(calls_.begin(), calls_.end(), method));
}

void FakeServer::wait_for_call(const std::string& method) const {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return std::find(calls_.begin(), calls_.end(), method) != calls_.end(); });
}

void FakeServer::wait_for_idle() const {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return idle_; });
}

grpc::Status FakeServer::begin(const std::string& method) {
  const std::lock_guard<std::mutex> guard(mutex_);
  calls_.push_back(method);
  changed_.notify_all();
  const auto found = std::find_if(failures_to_come_.begin(), failures_to_come_.end(),
                                  [&](const auto& failure) { return failure.first == method; });
  if (found == failures_to_come_.end()) return grpc::Status::OK;
  const grpc::Status status = found->second;
  failures_to_come_.erase(found);
  return status;
}

grpc::Status FakeServer::LeaseTask(grpc::ServerContext*, const v1::LeaseTaskRequest* request,
                                   v1::LeaseTaskResponse* response) {
  const grpc::Status status = begin("LeaseTask");
  const std::lock_guard<std::mutex> guard(mutex_);
  lease_requests_.push_back(*request);
  if (!status.ok()) return status;
  if (leases_.empty()) {
    // Workers that look ahead do not wait.
    idle_ = idle_ || request->wait_ms() > 0;
    changed_.notify_all();
    return status;
  }
  *response->mutable_lease() = leases_.front();
  leases_.pop_front();
  return status;
}

grpc::Status FakeServer::RenewLease(grpc::ServerContext*, const v1::RenewLeaseRequest*,
                                    v1::ReportResponse* response) {
  const grpc::Status status = begin("RenewLease");
  const std::lock_guard<std::mutex> guard(mutex_);
  if (!hold_next_) response->set_cancelled(std::exchange(cancel_next_renewal_, false));
  return status;
}

grpc::Status FakeServer::ReportErosion(grpc::ServerContext*,
                                       grpc::ServerReader<v1::ReportErosionRequest>* reader,
                                       v1::ReportResponse* response) {
  const grpc::Status status = begin("ReportErosion");
  if (!status.ok()) return status;
  Report report;
  v1::ReportErosionRequest part;
  while (reader->Read(&part)) {
    if (part.has_header()) {
      report.header = part.header();
    } else {
      report.records.MergeFrom(part.records());
      report.refined.MergeFrom(part.refined());
    }
  }
  std::function<v1::ReportResponse(const v1::ReportErosionHeader&)> answer;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    reports_.push_back(report);
    answer = answer_;
  }
  if (answer) *response = answer(report.header);
  return grpc::Status::OK;
}

grpc::Status FakeServer::CompleteTask(grpc::ServerContext* context,
                                      grpc::ServerReader<v1::CompleteTaskRequest>* reader,
                                      v1::ReportResponse*) {
  const grpc::Status status = begin("CompleteTask");
  if (!status.ok()) return status;
  Completion completion;
  completion.time_left = context->deadline() - std::chrono::system_clock::now();
  v1::CompleteTaskRequest part;
  while (reader->Read(&part)) {
    if (part.has_header()) {
      completion.header = part.header();
    } else {
      completion.data += part.data();
    }
  }
  const std::lock_guard<std::mutex> guard(mutex_);
  completions_.push_back(completion);
  return grpc::Status::OK;
}

grpc::Status FakeServer::FailTask(grpc::ServerContext*, const v1::FailTaskRequest* request,
                                  v1::ReportResponse*) {
  const grpc::Status status = begin("FailTask");
  const std::lock_guard<std::mutex> guard(mutex_);
  failures_.push_back(*request);
  return status;
}

grpc::Status FakeServer::ReturnLease(grpc::ServerContext*, const v1::ReturnLeaseRequest*,
                                     v1::ReportResponse*) {
  return begin("ReturnLease");
}

grpc::Status FakeServer::FetchInput(grpc::ServerContext*, const v1::FetchInputRequest* request,
                                    grpc::ServerWriter<v1::FetchArtifactResponse>* writer) {
  const grpc::Status status = begin("FetchInput" + std::to_string(request->kind()));
  if (!status.ok()) return status;
  if (take_hold()) {
    while (writer->Write(v1::FetchArtifactResponse())) {
    }
    return grpc::Status::CANCELLED;
  }
  std::string bytes;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    for (const auto& [kind, input] : inputs_) {
      if (kind == request->kind()) bytes = input;
    }
  }
  v1::FetchArtifactResponse part;
  part.mutable_header()->set_bytes(bytes.size());
  part.mutable_header()->set_sha256(wire::sha256_hex(bytes));
  writer->Write(part);
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (damage_next_ && !bytes.empty())
      bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    damage_next_ = false;
  }
  for (std::size_t from = 0; from < bytes.size(); from += 1000) {
    part.set_data(bytes.substr(from, 1000));
    writer->Write(part);
  }
  return grpc::Status::OK;
}

}  // namespace affskel::worker
