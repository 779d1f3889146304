#include "client/connection/transfers.h"

#include <chrono>
#include <optional>

#include "client/base/error.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

// Counts and hashes what passes through.
class CheckedTransfer {
 public:
  CheckedTransfer(const v1::ArtifactHeader& header, ArtifactSink& sink) : header_(header), sink_(sink) {
    sink_.begin(header_);
  }
  void data(std::string_view bytes) {
    received_ += bytes.size();
    hash_.update(bytes);
    sink_.data(bytes);
  }
  void end() {
    if (received_ != header_.bytes()) {
      throw ClientError(ExitCode::kInternal, "the artefact was cut short: " + std::to_string(received_) +
                                                 " of " + std::to_string(header_.bytes()) + " bytes arrived");
    }
    if (const std::string digest = hash_.hex_digest(); digest != header_.sha256()) {
      throw ClientError(ExitCode::kInternal, "the artefact was damaged on its way: SHA-256 " + digest +
                                                 " instead of " + header_.sha256());
    }
    sink_.end();
  }

 private:
  v1::ArtifactHeader header_;
  ArtifactSink& sink_;
  wire::Sha256 hash_;
  std::uint64_t received_ = 0;
};

}  // namespace

grpc::Status fetch_once(v1::ErosionService::Stub& stub, grpc::ClientContext& context,
                        const v1::FetchArtifactRequest& request, ArtifactSink& sink,
                        v1::ArtifactHeader& header) {
  const auto reader = stub.FetchArtifact(&context, request);
  std::optional<CheckedTransfer> transfer;
  v1::FetchArtifactResponse message;
  try {
    while (reader->Read(&message)) {
      if (message.has_header() && !transfer) {
        header = message.header();
        transfer.emplace(header, sink);
      } else if (!message.has_header() && transfer) {
        transfer->data(message.data());
      } else {
        throw ClientError(ExitCode::kInternal, "the server sent the parts of the artefact out of order");
      }
    }
  } catch (...) {
    context.TryCancel();  // the stream must be finished before it is destroyed
    reader->Finish();
    throw;
  }
  grpc::Status status = reader->Finish();
  if (!status.ok()) return status;
  if (!transfer) throw ClientError(ExitCode::kInternal, "the server sent no artefact");
  transfer->end();
  return status;
}

grpc::Status submit_once(v1::ErosionService::Stub& stub, grpc::ClientContext& context,
                         const v1::SubmitJobHeader& header, const GivenMeshes& meshes,
                         v1::SubmitJobResponse& response) {
  const auto bytes_per_second = std::size_t{1} << 20;
  const std::size_t bytes = meshes.mesh.size() + meshes.source.size();
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(120 + bytes / bytes_per_second));
  const auto writer = stub.SubmitJob(&context, &response);
  v1::SubmitJobRequest message;
  *message.mutable_header() = header;
  bool open = writer->Write(message);
  for (const std::string_view mesh : {meshes.mesh, meshes.source}) {
    for (std::size_t begin = 0; open && begin < mesh.size(); begin += wire::kChunkBytes) {
      const std::string_view piece = mesh.substr(begin, wire::kChunkBytes);
      message.set_data(piece.data(), piece.size());
      open = writer->Write(message);
    }
  }
  if (open) writer->WritesDone();
  return writer->Finish();
}

}  // namespace affskel::client
