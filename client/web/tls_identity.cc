#include "client/web/tls_identity.h"

#include <openssl/x509v3.h>

#include "client/base/error.h"

namespace affskel::client {
namespace {

net::TlsFiles open(const std::string& certificate, const std::string& key) {
  try {
    return net::TlsFiles({certificate, key, {}});
  } catch (const net::TlsFileError& error) {
    const bool is_key = error.kind() == net::TlsFileError::Kind::kKey;
    throw ClientError(ExitCode::kUsage,
                      (is_key ? "is no private key in PEM that can be read and fits the certificate: "
                              : "is no certificate in PEM that can be read: ") +
                          error.cause(),
                      error.file());
  }
}

}  // namespace

TlsIdentity::TlsIdentity(const std::string& certificate, const std::string& key)
    : files_(open(certificate, key)) {}

std::shared_ptr<boost::asio::ssl::context> TlsIdentity::context() {
  try {
    files_.look();
  } catch (const net::TlsFileError&) {
    // One file of the pair is not there yet: tried again with the next connection.
  }
  return files_.context();
}

bool TlsIdentity::names(const std::string& host) const {
  const auto context = files_.context();
  X509* const certificate = SSL_CTX_get0_certificate(context->native_handle());
  return certificate != nullptr && (X509_check_host(certificate, host.data(), host.size(), 0, nullptr) == 1 ||
                                    X509_check_ip_asc(certificate, host.c_str(), 0) == 1);
}

}  // namespace affskel::client
