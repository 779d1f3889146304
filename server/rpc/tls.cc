#include "rpc/tls.h"

#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "base/regular_file.h"

namespace affskel::server {
namespace {

// Between gRPC's looks at the files in use.
constexpr unsigned kReloadSeconds = 1;

[[noreturn]] void refuse(const std::string& file, const char* what) {
  std::array<char, 256> reason{};
  const unsigned long error = ERR_get_error();
  if (error != 0) ERR_error_string_n(error, reason.data(), reason.size());
  ERR_clear_error();
  throw std::runtime_error(file + ": " + what + (error != 0 ? std::string(" (") + reason.data() + ")" : ""));
}

std::string read_file(const std::string& file) {
  if (const char* kind = base::kind_unless_regular(file)) {
    throw std::runtime_error(file + ": " + kind + ", not a regular file");
  }
  std::ifstream in(file, std::ios::binary);
  std::string bytes;
  if (in) bytes.assign(std::istreambuf_iterator<char>(in), {});
  if (!in) throw std::runtime_error(file + ": cannot be read: " + std::strerror(errno));
  return bytes;
}

/// Changes whenever one of the files does.
std::string stamp_of(const TlsOptions& options) {
  std::string stamp;
  for (const std::string* file : {&options.certificate, &options.key, &options.client_ca}) {
    struct stat status {};
    if (!file->empty() && stat(file->c_str(), &status) != 0) status = {};
    for (const long part : {static_cast<long>(status.st_ino), static_cast<long>(status.st_size),
                            status.st_mtim.tv_sec, status.st_mtim.tv_nsec})
      stamp += std::to_string(part) + ' ';
  }
  return stamp;
}

/// Whether they are good together.  @param shown as their user named them, @param read where their contents
/// are.
void check(const TlsOptions& shown, const TlsOptions& read) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_server_method()),
                                                                  SSL_CTX_free);
  if (context == nullptr) throw std::runtime_error("OpenSSL cannot be used");
  ERR_clear_error();
  if (SSL_CTX_use_certificate_chain_file(context.get(), read.certificate.c_str()) != 1) {
    refuse(shown.certificate, "no certificate in PEM form that can be read");
  }
  if (SSL_CTX_use_PrivateKey_file(context.get(), read.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    refuse(shown.key, "no private key in PEM form that can be read, or not that of the certificate");
  }
  if (!read.client_ca.empty() &&
      SSL_CTX_load_verify_locations(context.get(), read.client_ca.c_str(), nullptr) != 1) {
    refuse(shown.client_ca, "no certificate in PEM form that can be read");
  }
}

}  // namespace

/// Good together; each empty or the bytes of its file.
struct TlsFiles::Contents {
  std::string certificate, key, client_ca;

  explicit Contents(const TlsOptions& options)
      : certificate(read_file(options.certificate)), key(read_file(options.key)) {
    if (!options.client_ca.empty()) client_ca = read_file(options.client_ca);
    const base::MemoryFile of_certificate(options.certificate, certificate), of_key(options.key, key),
        of_ca(options.client_ca, client_ca);
    check(options, {of_certificate.path(), of_key.path(), options.client_ca.empty() ? "" : of_ca.path()});
  }
};

TlsFiles::TlsFiles(TlsOptions options) : options_(std::move(options)), stamp_(stamp_of(options_)) {
  const Contents contents(options_);
  certificate_ = std::make_unique<base::MemoryFile>(options_.certificate, contents.certificate);
  key_ = std::make_unique<base::MemoryFile>(options_.key, contents.key);
  if (!options_.client_ca.empty())
    client_ca_ = std::make_unique<base::MemoryFile>(options_.client_ca, contents.client_ca);
}

TlsOptions TlsFiles::in_use() const {
  return {certificate_->path(), key_->path(), client_ca_ ? client_ca_->path() : std::string()};
}

std::shared_ptr<grpc::ServerCredentials> TlsFiles::credentials() const {
  const TlsOptions files = in_use();
  grpc::experimental::TlsServerCredentialsOptions tls(
      std::make_shared<grpc::experimental::FileWatcherCertificateProvider>(files.key, files.certificate,
                                                                           files.client_ca, kReloadSeconds));
  tls.watch_identity_key_cert_pairs();
  if (client_ca_) {
    tls.watch_root_certs();
    // A certificate that is shown is verified here.  That there is one is asked by the gate, which can say
    // so.
    tls.set_cert_request_type(GRPC_SSL_REQUEST_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return grpc::experimental::TlsServerCredentials(tls);
}

void TlsFiles::look() {
  std::string stamp = stamp_of(options_);
  if (stamp == stamp_) return;
  stamp_ = std::move(stamp);
  const Contents contents(options_);
  // Between the first and the second gRPC may read a pair that does not match: it looks again a second later.
  key_->replace(contents.key);
  certificate_->replace(contents.certificate);
  if (client_ca_) client_ca_->replace(contents.client_ca);
}

}  // namespace affskel::server
