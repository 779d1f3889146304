#pragma once

// First: Asio 1.74 uses std::exchange without its header.
#include <utility>

#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>
#include <string>

namespace affskel::client {

/// The certificate with which an HTTPS service shows who it is, and its key.  Read again when one of the
/// files changes, so that a renewed certificate needs no restart.  Not thread-safe.
class TlsIdentity {
 public:
  /// @param certificate PEM, the chain from the service's own; @param key PEM, not encrypted.
  /// @throws ClientError kUsage naming the file and the cause.
  TlsIdentity(std::filesystem::path certificate, std::filesystem::path key);

  /// For new connections.  Where changed files cannot be used, the context as it was.
  std::shared_ptr<boost::asio::ssl::context> context();

  /// Whether the certificate is for this host name or IP address.
  bool names(const std::string& host) const;

 private:
  struct Stamp {
    std::filesystem::file_time_type certificate, key;
    bool operator==(const Stamp&) const = default;
  };
  Stamp stamp() const;

  std::filesystem::path certificate_, key_;
  Stamp stamp_;
  std::shared_ptr<boost::asio::ssl::context> context_;
};

}  // namespace affskel::client
