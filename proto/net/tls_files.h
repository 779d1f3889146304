#pragma once

// First: Asio 1.74 uses std::exchange without its header.
#include <utility>

#include <boost/asio/ssl/context.hpp>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/mutex.h"
#include "base/watched_files.h"

namespace affskel::net {

/// Files in PEM form.
struct TlsOptions {
  std::string certificate;  ///< the server's, with what its signers need; empty = no TLS
  std::string key;          ///< its private key, not encrypted
  std::string client_ca;    ///< the possible signers of clients' certificates; empty = clients need none
};

/// A file of TLS that cannot be used; says which and why.
class TlsFileError : public std::runtime_error {
 public:
  enum class Kind { kCertificate, kKey, kClientCa };

  /// @param what is wrong with it, and as its cause says.
  TlsFileError(Kind kind, const std::string& file, const std::string& what, std::string cause)
      : std::runtime_error(file + ": " + what), kind_(kind), file_(file), cause_(std::move(cause)) {}

  Kind kind() const { return kind_; }
  const std::string& file() const { return file_; }
  /// In the words of the system or of OpenSSL.
  const std::string& cause() const { return cause_; }

 private:
  Kind kind_;
  std::string file_, cause_;
};

/// The files of TLS as they were when they were last good together.  Thread-safe.
class TlsFiles {
 public:
  /// Adds to a context what its protocol needs.
  using Prepare = std::function<void(SSL_CTX* context)>;

  /// @throws TlsFileError when the files are not good now.
  explicit TlsFiles(TlsOptions options, Prepare prepare = {});

  /// What new connections speak TLS with: 1.2 or later.  A client's certificate, if it shows one, is verified
  /// here where there are signers; that there is one is asked by others, which can say so.
  std::shared_ptr<boost::asio::ssl::context> context() const;

  /// Takes files that have changed since the last look into use if they are good together.  For one thread.
  /// @throws TlsFileError once for each change, when they are not: those that were in use stay, and these are
  ///   tried again at every look.
  void look();

 private:
  const TlsOptions options_;
  const Prepare prepare_;
  base::WatchedFiles watched_;
  bool is_behind_ = false;  // the files of the last look were not good
  mutable base::Mutex mutex_;
  std::shared_ptr<boost::asio::ssl::context> context_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::net
