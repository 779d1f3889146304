#include "client/web/tls_identity.h"

#include <openssl/x509v3.h>

#include "client/base/error.h"

namespace affskel::client {
namespace {

namespace ssl = boost::asio::ssl;

std::shared_ptr<ssl::context> load(const std::filesystem::path& certificate,
                                   const std::filesystem::path& key) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  SSL_CTX_set_session_cache_mode(context->native_handle(), SSL_SESS_CACHE_OFF);
  boost::system::error_code error;
  context->use_certificate_chain_file(certificate, error);
  if (error) {
    throw ClientError(ExitCode::kUsage, "is no certificate in PEM that can be read: " + error.message(),
                      certificate);
  }
  context->use_private_key_file(key, ssl::context::pem, error);
  if (error) {
    throw ClientError(
        ExitCode::kUsage,
        "is no private key in PEM that can be read and fits the certificate: " + error.message(), key);
  }
  return context;
}

}  // namespace

TlsIdentity::TlsIdentity(std::filesystem::path certificate, std::filesystem::path key)
    : certificate_(std::move(certificate)),
      key_(std::move(key)),
      stamp_(stamp()),
      context_(load(certificate_, key_)) {}

TlsIdentity::Stamp TlsIdentity::stamp() const {
  std::error_code ignored;
  return {std::filesystem::last_write_time(certificate_, ignored),
          std::filesystem::last_write_time(key_, ignored)};
}

std::shared_ptr<ssl::context> TlsIdentity::context() {
  const Stamp now = stamp();
  if (now == stamp_) return context_;
  try {
    context_ = load(certificate_, key_);
    stamp_ = now;
  } catch (const ClientError&) {
    // One file of the pair is not there yet: tried again with the next connection.
  }
  return context_;
}

bool TlsIdentity::names(const std::string& host) const {
  X509* const certificate = SSL_CTX_get0_certificate(context_->native_handle());
  return certificate != nullptr && (X509_check_host(certificate, host.data(), host.size(), 0, nullptr) == 1 ||
                                    X509_check_ip_asc(certificate, host.c_str(), 0) == 1);
}

}  // namespace affskel::client
