#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>

#include "affskel/v1/client_service.pb.h"
#include "calls/stream_call.h"
#include "store/blobs.h"

namespace affskel::server {

/// A call that sends something stored.  It holds one piece of it; the next is read from the database when
/// the peer has taken this one.
class Sending : public StreamCall, public grpc::ServerWriteReactor<v1::FetchArtifactResponse> {
 public:
  void OnWriteDone(bool ok) final;
  void OnCancel() final { end(grpc::Status::CANCELLED); }
  void OnDone() final { done(); }

 protected:
  using StreamCall::StreamCall;
  ~Sending() override = default;

  /// What a body returns when all is ready: sends the header, then the data.
  After send(CallLimit::Place place, std::unique_ptr<BlobReader> reader, const v1::Job* job);

 private:
  /// The peer has taken a message.
  virtual void on_taken() {}
  /// gRPC is done with the call.
  virtual void on_ended() {}

  After next();
  void move() final;
  bool writes() const final { return true; }
  void send_status(const grpc::Status& status) final { Finish(status); }
  void ended() final;

  CallLimit::Place place_;
  std::unique_ptr<BlobReader> reader_;
  std::string piece_;
  std::size_t sent_ = 0;  // of the piece
  v1::FetchArtifactResponse message_;
};

}  // namespace affskel::server
