#include "traffic/tls.h"

#include <openssl/ssl.h>
#include <sys/stat.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "base/regular_file.h"

namespace affskel::server {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using Context = asio::ssl::context;

void require(const error_code& error, const std::string& file, const char* what) {
  if (error) throw std::runtime_error(file + ": " + what + " (" + error.message() + ")");
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

/// Of what the client offers, HTTP/2 and nothing else.
int select_protocol(SSL*, const unsigned char** selected, unsigned char* size, const unsigned char* offered,
                    unsigned offered_size, void*) {
  static constexpr unsigned char kHttp2[] = {2, 'h', '2'};
  unsigned char* found = nullptr;
  if (SSL_select_next_proto(&found, size, kHttp2, sizeof kHttp2, offered, offered_size) !=
      OPENSSL_NPN_NEGOTIATED)
    return SSL_TLSEXT_ERR_ALERT_FATAL;
  *selected = found;
  return SSL_TLSEXT_ERR_OK;
}

/// Without what a peer could use to make the server work or keep something for it.
void set_up(SSL_CTX* context) {
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_TICKET | SSL_OP_NO_COMPRESSION);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_alpn_select_cb(context, select_protocol, nullptr);
}

/// Of the files as they are now.
std::shared_ptr<Context> read_context(const TlsOptions& options) {
  const std::string certificate = read_file(options.certificate), key = read_file(options.key);
  const auto context = std::make_shared<Context>(Context::tls_server);
  set_up(context->native_handle());
  // A key that is encrypted is refused, and not asked a password for.
  context->set_password_callback([](std::size_t, Context::password_purpose) { return std::string(); });
  error_code error;
  context->use_certificate_chain(asio::buffer(certificate), error);
  require(error, options.certificate, "no certificate in PEM form that can be read");
  context->use_private_key(asio::buffer(key), Context::pem, error);
  require(error, options.key, "no private key in PEM form that can be read, or not that of the certificate");
  if (options.client_ca.empty()) return context;
  context->add_certificate_authority(asio::buffer(read_file(options.client_ca)), error);
  require(error, options.client_ca, "no certificate in PEM form that can be read");
  context->set_verify_mode(asio::ssl::verify_peer);
  return context;
}

}  // namespace

TlsFiles::TlsFiles(TlsOptions options)
    : options_(std::move(options)), stamp_(stamp_of(options_)), context_(read_context(options_)) {}

std::shared_ptr<Context> TlsFiles::context() const {
  const base::MutexLock lock(mutex_);
  return context_;
}

void TlsFiles::look() {
  std::string stamp = stamp_of(options_);
  if (stamp == stamp_) return;
  stamp_ = std::move(stamp);
  std::shared_ptr<Context> context = read_context(options_);
  const base::MutexLock lock(mutex_);
  context_.swap(context);
}

}  // namespace affskel::server
