#include "test_authority.h"

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <cstdio>
#include <memory>
#include <stdexcept>

namespace affskel::tests {
namespace {

using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;

void extend(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value);
  if (extension == nullptr) throw std::runtime_error("X509V3_EXT_conf_nid");
  X509_add_ext(certificate, extension, -1);
  X509_EXTENSION_free(extension);
}

Certificate certificate_for(const std::string& name, EVP_PKEY* key) {
  Certificate certificate(X509_new(), X509_free);
  X509_set_version(certificate.get(), 2);
  std::uint32_t serial = 0;
  RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial);
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate.get()), serial);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -3600);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600);
  X509_set_pubkey(certificate.get(), key);
  X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate.get()), "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  return certificate;
}

template <typename Write>
void write_file(const std::string& path, Write write) {
  const std::string unfinished = path + ".new";
  std::FILE* const out = std::fopen(unfinished.c_str(), "w");
  if (out == nullptr) throw std::runtime_error(unfinished);
  const bool good = write(out) == 1;
  if (std::fclose(out) != 0 || !good) throw std::runtime_error(unfinished);
  std::filesystem::rename(unfinished, path);
}

}  // namespace

struct TestAuthority::Pair {
  Key key{EVP_EC_gen("P-256"), EVP_PKEY_free};
  Certificate certificate{nullptr, X509_free};

  void write(const TestAuthority& authority, const std::string& name) const {
    write_file(authority.key(name), [&](std::FILE* out) {
      return PEM_write_PrivateKey(out, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
    });
    write_file(authority.certificate(name),
               [&](std::FILE* out) { return PEM_write_X509(out, certificate.get()); });
  }
};

TestAuthority::TestAuthority(const std::filesystem::path& directory, const std::string& name)
    : directory_(directory), name_(name), own_(new Pair) {
  own_->certificate = certificate_for(name, own_->key.get());
  X509* const own = own_->certificate.get();
  X509_set_issuer_name(own, X509_get_subject_name(own));
  extend(own, own, NID_basic_constraints, "critical,CA:TRUE");
  extend(own, own, NID_key_usage, "critical,keyCertSign,cRLSign");
  X509_sign(own, own_->key.get(), EVP_sha256());
  own_->write(*this, name);
}

TestAuthority::~TestAuthority() {
  delete own_;
}

void TestAuthority::sign(const std::string& name) const {
  Pair pair;
  pair.certificate = certificate_for(name, pair.key.get());
  X509* const issuer = own_->certificate.get();
  X509_set_issuer_name(pair.certificate.get(), X509_get_subject_name(issuer));
  extend(pair.certificate.get(), issuer, NID_subject_alt_name, "DNS:localhost,IP:127.0.0.1");
  X509_sign(pair.certificate.get(), own_->key.get(), EVP_sha256());
  pair.write(*this, name);
}

}  // namespace affskel::tests
