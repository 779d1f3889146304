#pragma once

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <string>

namespace affskel::server {

/// Files in PEM form.
struct TlsOptions {
  std::string certificate;  ///< the server's, with what its signers need; empty = no TLS
  std::string key;          ///< its private key
  std::string client_ca;    ///< who may have signed clients' certificates; empty = clients need none
};

/// What gRPC speaks TLS with.  Files that are replaced are used for connections made a few seconds later.  While
/// they are not whole, or certificate and key do not match, new connections fail and those that are there go on.
/// @throws std::runtime_error naming the file and the cause when the files are not good now.
std::shared_ptr<grpc::ServerCredentials> tls_credentials(const TlsOptions& options);

}  // namespace affskel::server
