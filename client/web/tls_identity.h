#pragma once

#include <memory>
#include <string>

#include "net/tls_files.h"

namespace affskel::client {

/// The certificate by which an HTTPS service is known, and its key.  Read again when one of the
/// files changes, so that a renewed certificate needs no restart.  Not thread-safe.
class TlsIdentity {
 public:
  /// @param certificate PEM, the chain from the service's own; @param key PEM, not encrypted.
  /// @throws ClientError kUsage naming the file and the cause.
  TlsIdentity(const std::string& certificate, const std::string& key);

  /// For new connections.  Where changed files cannot be used, the context as it was.
  std::shared_ptr<boost::asio::ssl::context> context();

  /// Whether the certificate is for this host name or IP address.
  bool names(const std::string& host) const;

 private:
  net::TlsFiles files_;
};

}  // namespace affskel::client
