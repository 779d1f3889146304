#pragma once

#include <filesystem>
#include <string>

namespace affskel::tests {

/// An authority of the test's own, which signs certificates for this machine; files in PEM form.
class TestAuthority {
 public:
  /// @param directory where its files go: NAME.pem and NAME.key.
  TestAuthority(const std::filesystem::path& directory, const std::string& name);
  ~TestAuthority();
  TestAuthority(const TestAuthority&) = delete;
  TestAuthority& operator=(const TestAuthority&) = delete;

  /// Its own certificate.
  std::string file() const { return (directory_ / (name_ + ".pem")).string(); }

  /// Signs a certificate for localhost and 127.0.0.1 and writes it, with its key, as `name`.pem and
  /// `name`.key, each in one step.
  void sign(const std::string& name) const;

  std::string certificate(const std::string& name) const { return (directory_ / (name + ".pem")).string(); }
  std::string key(const std::string& name) const { return (directory_ / (name + ".key")).string(); }

 private:
  struct Pair;
  std::filesystem::path directory_;
  std::string name_;
  Pair* own_;
};

}  // namespace affskel::tests
