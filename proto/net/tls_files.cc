#include "net/tls_files.h"

#include <openssl/ssl.h>

#include <boost/asio/buffer.hpp>
#include <cstddef>

#include "base/read_file.h"
#include "base/regular_file.h"

namespace affskel::net {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using Context = asio::ssl::context;
using Kind = TlsFileError::Kind;

void require(const error_code& error, Kind kind, const std::string& file, const std::string& what) {
  if (error) throw TlsFileError(kind, file, what + " (" + error.message() + ")", error.message());
}

std::string read(Kind kind, const std::string& file) {
  if (const char* other = base::kind_unless_regular(file)) {
    const std::string what = std::string(other) + ", not a regular file";
    throw TlsFileError(kind, file, what, what);
  }
  try {
    return base::read_file(file);
  } catch (const base::FileError& error) {
    const std::string cause = error.code().message();
    throw TlsFileError(kind, file, "cannot be read: " + cause, cause);
  }
}

/// Without what a peer could use to make the server work or keep something for it.
void set_up(SSL_CTX* context) {
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
}

/// Of the files as they are now.
std::shared_ptr<Context> read_context(const TlsOptions& options, const TlsFiles::Prepare& prepare) {
  const std::string certificate = read(Kind::kCertificate, options.certificate);
  const std::string key = read(Kind::kKey, options.key);
  const auto context = std::make_shared<Context>(Context::tls_server);
  set_up(context->native_handle());
  if (prepare) prepare(context->native_handle());
  // A key that is encrypted is refused, and not asked a password for.
  context->set_password_callback([](std::size_t, Context::password_purpose) { return std::string(); });
  error_code error;
  context->use_certificate_chain(asio::buffer(certificate), error);
  require(error, Kind::kCertificate, options.certificate, "no certificate in PEM form that can be read");
  context->use_private_key(asio::buffer(key), Context::pem, error);
  require(error, Kind::kKey, options.key,
          "no private key in PEM form that can be read, or not that of the certificate");
  if (options.client_ca.empty()) return context;
  context->add_certificate_authority(asio::buffer(read(Kind::kClientCa, options.client_ca)), error);
  require(error, Kind::kClientCa, options.client_ca, "no certificate in PEM form that can be read");
  context->set_verify_mode(asio::ssl::verify_peer);
  return context;
}

}  // namespace

TlsFiles::TlsFiles(TlsOptions options, Prepare prepare)
    : options_(std::move(options)),
      prepare_(std::move(prepare)),
      watched_({options_.certificate, options_.key, options_.client_ca}),
      context_(read_context(options_, prepare_)) {}

std::shared_ptr<Context> TlsFiles::context() const {
  const base::MutexLock lock(mutex_);
  return context_;
}

void TlsFiles::look() {
  const bool changed = watched_.changed();
  if (!changed && !is_behind_) return;
  is_behind_ = true;
  std::shared_ptr<Context> context;
  try {
    context = read_context(options_, prepare_);
  } catch (const TlsFileError&) {
    if (changed) throw;
    return;
  }
  is_behind_ = false;
  const base::MutexLock lock(mutex_);
  context_.swap(context);
}

}  // namespace affskel::net
