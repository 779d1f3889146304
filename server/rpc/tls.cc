#include "rpc/tls.h"

#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include <array>
#include <stdexcept>

namespace affskel::server {
namespace {

// Between looks at the files.
constexpr unsigned kReloadSeconds = 2;

[[noreturn]] void refuse(const std::string& file, const char* what) {
  std::array<char, 256> reason{};
  const unsigned long error = ERR_get_error();
  if (error != 0) ERR_error_string_n(error, reason.data(), reason.size());
  ERR_clear_error();
  throw std::runtime_error(file + ": " + what + (error != 0 ? std::string(" (") + reason.data() + ")" : ""));
}

/// gRPC would only log, and then refuse every connection.
void check_files(const TlsOptions& options) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_server_method()),
                                                                  SSL_CTX_free);
  if (context == nullptr) throw std::runtime_error("OpenSSL cannot be used");
  ERR_clear_error();
  if (SSL_CTX_use_certificate_chain_file(context.get(), options.certificate.c_str()) != 1) {
    refuse(options.certificate, "no certificate in PEM form that can be read");
  }
  if (SSL_CTX_use_PrivateKey_file(context.get(), options.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    refuse(options.key, "no private key in PEM form that can be read, or not that of the certificate");
  }
  if (!options.client_ca.empty() &&
      SSL_CTX_load_verify_locations(context.get(), options.client_ca.c_str(), nullptr) != 1) {
    refuse(options.client_ca, "no certificate in PEM form that can be read");
  }
}

}  // namespace

std::shared_ptr<grpc::ServerCredentials> tls_credentials(const TlsOptions& options) {
  check_files(options);
  grpc::experimental::TlsServerCredentialsOptions tls(
      std::make_shared<grpc::experimental::FileWatcherCertificateProvider>(
          options.key, options.certificate, options.client_ca, kReloadSeconds));
  tls.watch_identity_key_cert_pairs();
  if (!options.client_ca.empty()) {
    tls.watch_root_certs();
    // A certificate that is shown is verified here.  That there is one is asked by the gate, which can say
    // so.
    tls.set_cert_request_type(GRPC_SSL_REQUEST_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return grpc::experimental::TlsServerCredentials(tls);
}

}  // namespace affskel::server
