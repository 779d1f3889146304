#pragma once

#include <memory>
#include <string>

#include "base/mutex.h"

namespace boost::asio::ssl {
class context;
}

namespace affskel::server {

/// Files in PEM form.
struct TlsOptions {
  std::string certificate;  ///< the server's, with what its signers need; empty = no TLS
  std::string key;          ///< its private key
  std::string client_ca;    ///< who may have signed clients' certificates; empty = clients need none
};

/// The files of TLS as they were when they were last good together.  Thread-safe.
class TlsFiles {
 public:
  /// @throws std::runtime_error naming the file and the cause when the files are not good now.
  explicit TlsFiles(TlsOptions options);

  /// What new connections speak TLS with: 1.2 or later, HTTP/2.  A client's certificate, if it shows one, is
  /// verified here; that there is one is asked by the gate, which can say so.
  std::shared_ptr<boost::asio::ssl::context> context() const;

  /// Takes files that have changed since the last look into use if they are good together.  For one thread.
  /// @throws std::runtime_error naming the file and the cause, once for each change, when they are not: those
  ///   that were in use stay.
  void look();

 private:
  const TlsOptions options_;
  std::string stamp_;  // of the files at the last look
  mutable base::Mutex mutex_;
  std::shared_ptr<boost::asio::ssl::context> context_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server
