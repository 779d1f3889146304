#pragma once

#include <stdexcept>
#include <string>

namespace affskel::server {

/// A request that the store refuses; nothing was changed.  Mapped to gRPC codes in calls/status.cc.
class StoreError : public std::runtime_error {
 public:
  enum class Code {
    kInvalid,       ///< an argument is wrong
    kNotFound,      ///< no such job or artefact
    kExists,        ///< the request id was used for other content
    kPrecondition,  ///< the job's state does not allow it
    kFenced,        ///< the lease is gone
    kForbidden,     ///< the caller is not trusted with this
    kLimit,         ///< too large
    kUnusable,      ///< the database file is not ours, newer, or damaged
    kDamaged,       ///< stored bytes are not those that were stored
    kLost,          ///< the database was removed or replaced while the server ran
  };

  StoreError(Code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  Code code() const { return code_; }

 private:
  Code code_;
};

}  // namespace affskel::server
