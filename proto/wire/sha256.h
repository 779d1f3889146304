#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace affskel::wire {

/// Incremental SHA-256 (FIPS 180-4) over OpenSSL.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void update(std::string_view bytes);

  /// The digest as 64 lower-case hexadecimal digits.  Call once, last.
  std::string hex_digest();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// SHA-256 of `bytes` as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace affskel::wire
