#include "wire/channel.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <grpcpp/support/client_interceptor.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <sys/prctl.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/mutex.h"
#include "base/read_file.h"
#include "base/regular_file.h"
#include "base/watched_files.h"

namespace affskel::wire {
namespace {

// Far above any certificate chain and any token.
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;
// How often certificates and keys are looked at that may have been replaced.
constexpr unsigned kLookAtFilesSeconds = 1;

std::string read_access_file(const std::string& path, const char* what) {
  if (const char* kind = base::kind_unless_regular(path))
    throw std::invalid_argument(path + ": " + kind + ", not a file with a " + what);
  std::string text;
  try {
    text = base::read_file(path, kMaxFileBytes);
  } catch (const base::FileError& error) {
    throw std::invalid_argument(path + ": cannot read the " + what + ": " + error.code().message());
  }
  if (text.size() > kMaxFileBytes)
    throw std::invalid_argument(path + ": too large for a " + std::string(what));
  return text;
}

// gRPC would tell of a file without any that there is no address.  What is encrypted is not asked a password for.
template <class Read, class Free>
std::string read_pem(const std::string& path, const char* what, Read read, Free free) {
  std::string text = read_access_file(path, what);
  const std::unique_ptr<BIO, decltype(&BIO_free)> bytes(
      BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), &BIO_free);
  const auto no_password = [](char*, int, int, void*) { return -1; };
  auto* const first = read(bytes.get(), nullptr, no_password, nullptr);
  ERR_clear_error();
  if (first == nullptr) throw std::invalid_argument(path + ": no " + what + " in PEM form that can be read");
  free(first);
  return text;
}

std::string read_certificates(const std::string& path) {
  return read_pem(path, "certificate", PEM_read_bio_X509, X509_free);
}

/// The first line.  Metadata of gRPC are printable ASCII; the message quotes nothing of it.
std::string read_token(const std::string& path) {
  std::string text = read_access_file(path, "token");
  text.resize(std::min(text.find_first_of("\r\n"), text.size()));
  const bool good =
      !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > 0x20 && c < 0x7F; });
  if (!good) throw std::invalid_argument(path + ": its first line is no token");
  return text;
}

/// The token of a file, as the file is now.  Thread-safe.
class Token {
 public:
  explicit Token(std::string path) : path_(std::move(path)), watched_({path_}), text_(read_token(path_)) {}

  /// A file that is gone or broken leaves the token that was there.
  std::string text() {
    const base::MutexLock lock(mutex_);
    if (watched_.changed()) {
      try {
        text_ = read_token(path_);
      } catch (const std::invalid_argument&) {
      }
    }
    return text_;
  }

 private:
  const std::string path_;
  base::Mutex mutex_;
  base::WatchedFiles watched_ ABSL_GUARDED_BY(mutex_);
  std::string text_ ABSL_GUARDED_BY(mutex_);
};

/// Puts the token into a call's metadata.  An interceptor serves every transport; gRPC's call credentials
/// refuse those without TLS, Unix sockets among them.
class ShowToken final : public grpc::experimental::Interceptor {
 public:
  explicit ShowToken(std::shared_ptr<Token> token) : token_(std::move(token)) {}

  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    using Hook = grpc::experimental::InterceptionHookPoints;
    if (methods->QueryInterceptionHookPoint(Hook::PRE_SEND_INITIAL_METADATA)) {
      methods->GetSendInitialMetadata()->insert({"authorization", "Bearer " + token_->text()});
    }
    methods->Proceed();
  }

 private:
  std::shared_ptr<Token> token_;
};

class ShowTokenFactory final : public grpc::experimental::ClientInterceptorFactoryInterface {
 public:
  explicit ShowTokenFactory(std::shared_ptr<Token> token) : token_(std::move(token)) {}
  grpc::experimental::Interceptor* CreateClientInterceptor(grpc::experimental::ClientRpcInfo*) override {
    return new ShowToken(token_);  // gRPC takes it
  }

 private:
  std::shared_ptr<Token> token_;
};

std::shared_ptr<grpc::ChannelCredentials> credentials_of(const Address& address, const AccessFiles& files) {
  if (files.tls_cert.empty() != files.tls_key.empty()) {
    throw std::invalid_argument("a certificate and its key go together: " +
                                (files.tls_cert.empty() ? files.tls_key : files.tls_cert) + " is alone");
  }
  if (address.is_unix || files.tls_ca.empty()) return grpc::InsecureChannelCredentials();
  read_certificates(files.tls_ca);
  grpc::experimental::TlsChannelCredentialsOptions options;
  options.set_certificate_provider(std::make_shared<grpc::experimental::FileWatcherCertificateProvider>(
      files.tls_key, files.tls_cert, files.tls_ca, kLookAtFilesSeconds));
  options.watch_root_certs();
  if (!files.tls_cert.empty()) {
    read_certificates(files.tls_cert);
    read_pem(files.tls_key, "private key", PEM_read_bio_PrivateKey, EVP_PKEY_free);
    options.watch_identity_key_cert_pairs();
  }
  return grpc::experimental::TlsCredentials(options);
}

}  // namespace

void forbid_core_dumps() {
  prctl(PR_SET_DUMPABLE, 0);
}

std::shared_ptr<grpc::Channel> make_channel(const Address& address, const AccessFiles& files,
                                            const grpc::ChannelArguments& arguments) {
  const bool secret = !files.token_file.empty() || !files.tls_key.empty();
  if (secret) forbid_core_dumps();
  const std::shared_ptr<grpc::ChannelCredentials> credentials = credentials_of(address, files);
  std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> interceptors;
  if (!files.token_file.empty()) {
    if (files.tls_ca.empty() && !address.is_local()) {
      throw std::invalid_argument("the token of " + files.token_file + " would go to " + address.target() +
                                  " in the clear: say by --tls-ca how its server is known");
    }
    interceptors.push_back(std::make_unique<ShowTokenFactory>(std::make_shared<Token>(files.token_file)));
  }
  return grpc::experimental::CreateCustomChannelWithInterceptors(address.target(), credentials, arguments,
                                                                 std::move(interceptors));
}

}  // namespace affskel::wire
