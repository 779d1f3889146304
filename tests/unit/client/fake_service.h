#pragma once

#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "affskel/v1/client_service.grpc.pb.h"
#include "tools/temporary_directory.h"
#include "wire/params.h"
#include "wire/sha256.h"

namespace affskel::client {

/// A server in this process that answers as it is told.  What a test sets before the calls needs no lock.
class FakeService final : public v1::ErosionService::Service {
 public:
  v1::Job job;                       ///< answers every question about a job
  v1::ListJobEventsResponse events;  ///< of every job
  std::vector<v1::Job> watch;        ///< what WatchJob sends, one after the other
  int watch_breaks_after = -1;       ///< ends the first watch UNAVAILABLE after this many
  int watch_ends_after = -1;         ///< the same, ending it in order
  bool watch_stays_away = false;     ///< all further watches are UNAVAILABLE
  std::map<v1::ArtifactKind, std::string> artifacts;
  grpc::Status fails = grpc::Status::OK;  ///< when not OK, what every unary call answers
  std::function<void()> hold;             ///< called before a question about a job is answered
  int busy = 0;                           ///< so many questions about a job get busy_status first
  grpc::Status busy_status{grpc::StatusCode::UNAVAILABLE, "too many calls"};
  bool damage = false;  ///< flip a byte of every artefact
  bool existed = false;
  std::uint64_t max_mesh_bytes = 1 << 30;
  v1::Caller caller;                         ///< a caller without a token, as the server tells
  std::map<std::string, v1::Caller> tokens;  ///< when there are any, questions need one of them, "Bearer ..."

  v1::SubmitJobHeader submitted;  ///< as it arrived
  std::string mesh, source;
  std::vector<v1::FetchArtifactRequest> fetches;
  v1::ListJobsRequest listed;  ///< the last of these
  std::vector<v1::ListJobsRequest> lists;
  std::uint32_t jobs = 1;  ///< so many are listed, in pages
  int watches = 0;
  std::atomic<int> infos = 0;  ///< how often it was asked what it is

  grpc::Status SubmitJob(grpc::ServerContext*, grpc::ServerReader<v1::SubmitJobRequest>* reader,
                         v1::SubmitJobResponse* response) override {
    mesh.clear();
    v1::SubmitJobRequest message;
    while (reader->Read(&message)) {
      if (message.has_header()) {
        submitted = message.header();
        if (grpc::Status no = refused(submitted.params(), submitted.skeleton()); !no.ok()) return no;
      }
      mesh += message.data();
    }
    source = mesh.substr(std::min<std::size_t>(mesh.size(), submitted.mesh_bytes()));
    mesh.resize(mesh.size() - source.size());
    *response->mutable_job() = job;
    response->set_existed(existed);
    return fails;
  }
  grpc::Status GetJob(grpc::ServerContext*, const v1::GetJobRequest* request, v1::Job* response) override {
    if (hold) hold();
    if (request->job() == "000000") return {grpc::StatusCode::NOT_FOUND, "no job begins with 000000"};
    if (busy-- > 0) return busy_status;
    *response = job;
    return fails;
  }
  grpc::Status ListJobs(grpc::ServerContext* context, const v1::ListJobsRequest* request,
                        v1::ListJobsResponse* response) override {
    if (!caller_of(*context)) return kNoToken;
    listed = *request;
    lists.push_back(*request);
    for (std::uint32_t i = 0; i < std::min(jobs, request->limit()); ++i) *response->add_jobs() = job;
    jobs -= static_cast<std::uint32_t>(response->jobs_size());
    if (jobs > 0) response->set_next_page_token("left " + std::to_string(jobs));
    return fails;
  }
  grpc::Status WatchJob(grpc::ServerContext*, const v1::WatchJobRequest*,
                        grpc::ServerWriter<v1::Job>* writer) override {
    const bool first = watches++ == 0;
    int sent = 0;
    if (!first && watch_stays_away) return {grpc::StatusCode::UNAVAILABLE, "restarting"};
    for (const v1::Job& state : watch) {
      if (first && sent == watch_breaks_after) return {grpc::StatusCode::UNAVAILABLE, "restarting"};
      if (first && sent == watch_ends_after) return grpc::Status::OK;
      ++sent;
      writer->Write(state);
    }
    return grpc::Status::OK;
  }
  grpc::Status CancelJob(grpc::ServerContext*, const v1::CancelJobRequest*, v1::Job* response) override {
    *response = job;
    return fails;
  }
  grpc::Status ResumeJob(grpc::ServerContext*, const v1::ResumeJobRequest*, v1::Job* response) override {
    *response = job;
    return fails;
  }
  grpc::Status PinJob(grpc::ServerContext*, const v1::PinJobRequest*, v1::Job* response) override {
    job.set_pinned(true);
    *response = job;
    return fails;
  }
  grpc::Status UnpinJob(grpc::ServerContext*, const v1::UnpinJobRequest*, v1::Job* response) override {
    job.set_pinned(false);
    *response = job;
    return fails;
  }
  grpc::Status SetStance(grpc::ServerContext*, const v1::SetStanceRequest* request,
                         v1::Job* response) override {
    job.clear_stance();
    if (request->has_stance()) *job.mutable_stance() = request->stance();
    *response = job;
    return fails;
  }
  grpc::Status ListJobEvents(grpc::ServerContext*, const v1::ListJobEventsRequest*,
                             v1::ListJobEventsResponse* response) override {
    *response = events;
    return fails;
  }
  grpc::Status DeleteJob(grpc::ServerContext*, const v1::DeleteJobRequest*,
                         v1::DeleteJobResponse* response) override {
    response->set_id(job.id());
    return fails;
  }
  grpc::Status FetchArtifact(grpc::ServerContext*, const v1::FetchArtifactRequest* request,
                             grpc::ServerWriter<v1::FetchArtifactResponse>* writer) override {
    fetches.push_back(*request);
    if (request->has_skeleton())
      if (grpc::Status no = refused(request->skeleton()); !no.ok()) return no;
    if (request->has_eroded())
      if (grpc::Status no = refused(request->eroded()); !no.ok()) return no;
    const auto found = artifacts.find(request->kind());
    if (found == artifacts.end()) return {grpc::StatusCode::FAILED_PRECONDITION, "the job is still running"};
    std::string bytes = found->second;
    v1::FetchArtifactResponse message;
    message.mutable_header()->set_bytes(bytes.size());
    message.mutable_header()->set_sha256(wire::sha256_hex(bytes));
    *message.mutable_header()->mutable_job() = job;
    writer->Write(message);
    if (damage && !bytes.empty()) bytes.back() = static_cast<char>(bytes.back() ^ 1);
    constexpr std::size_t kPiece = 33;  // cuts records anywhere
    for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
      message.set_data(bytes.substr(at, kPiece));
      writer->Write(message);
    }
    return grpc::Status::OK;
  }
  grpc::Status GetServerInfo(grpc::ServerContext* context, const v1::GetServerInfoRequest*,
                             v1::ServerInfo* response) override {
    ++infos;
    const auto who = caller_of(*context);
    if (!who) return kNoToken;
    *response->mutable_caller() = *who;
    response->set_version("9.8.7");
    response->set_max_mesh_bytes(max_mesh_bytes);
    response->add_workers()->set_id("0123456789abcdef");
    return fails;
  }

 private:
  inline static const grpc::Status kNoToken{grpc::StatusCode::UNAUTHENTICATED, "no such token"};

  // What a server says of parameters that it refuses; OK for the others.
  template <class... Params>
  static grpc::Status refused(const Params&... params) {
    try {
      (static_cast<void>(wire::canonical(params)), ...);
      return grpc::Status::OK;
    } catch (const std::invalid_argument& error) {
      return {grpc::StatusCode::INVALID_ARGUMENT, error.what()};
    }
  }

  std::optional<v1::Caller> caller_of(const grpc::ServerContext& context) const {
    if (tokens.empty()) return caller;
    const auto shown = context.client_metadata().find("authorization");
    if (shown == context.client_metadata().end()) return std::nullopt;
    const auto found = tokens.find(std::string(shown->second.data(), shown->second.size()));
    return found == tokens.end() ? std::nullopt : std::optional(found->second);
  }
};

/// The service on a Unix socket of its own.
class FakeServer {
 public:
  explicit FakeServer(FakeService& service) {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::ServerBuilder builder;
    builder.AddListeningPort(address(), grpc::InsecureServerCredentials());
    builder.RegisterService(&service);
    server_ = builder.BuildAndStart();
  }
  ~FakeServer() { server_->Shutdown(); }
  std::string address() const { return "unix:" + (dir_ / "s"); }
  /// What the health service tells from now on.
  void set_serving(bool serving) { server_->GetHealthCheckService()->SetServingStatus(serving); }

 private:
  tests::TemporaryDirectory dir_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace affskel::client
