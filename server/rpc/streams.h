#pragma once

#include <grpcpp/support/sync_stream.h>

#include <algorithm>
#include <functional>
#include <string>

#include "affskel/v1/client_service.pb.h"
#include "errors.h"
#include "rpc/status.h"
#include "rpc/upload_budget.h"
#include "store/blobs.h"

namespace affskel::server {

/// Sends header and data of something stored.  Returns when all is sent or the peer has gone.
/// @param progress called after every message.
inline void send_blob(
    grpc::ServerWriter<v1::FetchArtifactResponse>& writer, BlobReader& reader, const v1::Job* job = nullptr,
    const std::function<void()>& progress = [] {}) {
  v1::FetchArtifactResponse message;
  message.mutable_header()->set_bytes(reader.bytes());
  message.mutable_header()->set_sha256(reader.sha256());
  if (job != nullptr) *message.mutable_header()->mutable_job() = *job;
  if (!writer.Write(message)) return;
  progress();
  for (std::string piece = reader.next(); !piece.empty(); piece = reader.next()) {
    message.set_data(std::move(piece));
    if (!writer.Write(message)) return;
    progress();
  }
}

/// Receives the data messages of an upload after its header.
/// @param announced bytes that the header promises; more are refused at once, not stored.
/// @param share holds the bytes in the server's budget; outlives the result.
/// @param progress called after every message.
/// @throws StoreError kInvalid on a second header or too many bytes, CallEnded when other uploads fill the
/// budget: UNAVAILABLE, for it soon has room again.
template <typename Request, typename Reader>
std::string receive_data(
    Reader& reader, std::uint64_t announced, UploadBudget::Share& share,
    const std::function<void()>& progress = [] {}) {
  // What is announced is not believed before it is there: reserve a little, then grow.
  constexpr std::uint64_t kReserveAtMost = std::uint64_t{64} << 20;
  std::string data;
  data.reserve(std::min(announced, kReserveAtMost));
  Request message;
  while (reader.Read(&message)) {
    if (message.part_case() != Request::kData) {
      throw StoreError(StoreError::Code::kInvalid, "only data may follow the header of an upload");
    }
    if (data.size() + message.data().size() > announced) {
      throw StoreError(StoreError::Code::kInvalid, "more data than the " + std::to_string(announced) +
                                                       " bytes that the header announced");
    }
    if (!share.take(message.data().size())) {
      throw CallEnded(
          {grpc::StatusCode::UNAVAILABLE, "the server is receiving as much as it can hold; try again"});
    }
    data += message.data();
    progress();
  }
  return data;
}

}  // namespace affskel::server
