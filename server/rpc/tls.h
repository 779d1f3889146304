#pragma once

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <string>

#include "base/memory_file.h"

namespace affskel::server {

/// Files in PEM form.
struct TlsOptions {
  std::string certificate;  ///< the server's, with what its signers need; empty = no TLS
  std::string key;          ///< its private key
  std::string client_ca;    ///< who may have signed clients' certificates; empty = clients need none
};

/// The files of TLS as they were when they were last good together.  gRPC reads them again by itself, but
/// looks at none, and with a file that is half written would refuse everybody.  Not thread-safe.
class TlsFiles {
 public:
  /// @throws std::runtime_error naming the file and the cause when the files are not good now.
  explicit TlsFiles(TlsOptions options);

  /// What gRPC speaks TLS with.  Connections are made with the files that are in use a second before.
  std::shared_ptr<grpc::ServerCredentials> credentials() const;

  /// Takes files that have changed since the last look into use if they are good together.
  /// @throws std::runtime_error naming the file and the cause, once for each change, when they are not: those
  ///   that were in use stay.
  void look();

  /// Where those in use are read.
  TlsOptions in_use() const;

 private:
  struct Contents;

  TlsOptions options_;
  std::string stamp_;  // of the files at the last look
  std::unique_ptr<base::MemoryFile> certificate_, key_, client_ca_;
};

}  // namespace affskel::server
