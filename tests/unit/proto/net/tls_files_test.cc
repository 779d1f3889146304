#include "net/tls_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tools/files.h"
#include "tools/temporary_directory.h"
#include "tools/test_authority.h"

namespace affskel::net {
namespace {

using Kind = TlsFileError::Kind;

class TlsFilesTest : public ::testing::Test {
 protected:
  TlsFilesTest() {
    authority_.sign("own");
    options_ = {authority_.certificate("own"), authority_.key("own"), authority_.file()};
  }
  static std::string look_at(TlsFiles& files) {
    try {
      files.look();
    } catch (const TlsFileError& error) {
      return error.what();
    }
    return "";
  }
  /// In one step: what is read meanwhile is the one or the other.
  void replace(const std::string& file, const std::string& bytes) const {
    tests::write_file(dir_ / "new", bytes);
    std::filesystem::rename(dir_ / "new", file);
  }

  tests::TemporaryDirectory dir_;
  tests::TestAuthority authority_{dir_.path(), "authority"};
  TlsOptions options_;
};

TEST_F(TlsFilesTest, WhatIsNotWholeYetIsNotUsed) {
  TlsFiles files(options_);
  const auto before = files.context();
  EXPECT_EQ(look_at(files), "");
  authority_.sign("renewed");
  replace(options_.certificate, "-----BEGIN CERTIF");
  EXPECT_NE(look_at(files).find("own.pem: no certificate"), std::string::npos);
  EXPECT_EQ(look_at(files), "") << "told once";
  replace(options_.certificate, tests::read_file(authority_.certificate("renewed")));
  EXPECT_NE(look_at(files).find("own.key: no private key"), std::string::npos) << "the key is yet to come";
  std::filesystem::remove(options_.key);
  EXPECT_NE(look_at(files).find("own.key: cannot be read: No such file"), std::string::npos);
  EXPECT_EQ(files.context(), before);
  replace(options_.key, tests::read_file(authority_.key("renewed")));
  EXPECT_EQ(look_at(files), "");
  EXPECT_NE(files.context(), before);
}

TEST_F(TlsFilesTest, ErrorsNameTheFile) {
  tests::write_file(dir_ / "rubbish", "rubbish");
  const auto expect = [&](const TlsOptions& options, Kind kind, const std::string& file,
                          const std::string& what) {
    try {
      const TlsFiles files(options);
      ADD_FAILURE() << file << " was taken";
    } catch (const TlsFileError& error) {
      EXPECT_EQ(error.kind(), kind) << file;
      EXPECT_EQ(error.file(), file);
      EXPECT_NE(std::string(error.what()).find(file + ": " + what), std::string::npos) << error.what();
      EXPECT_FALSE(error.cause().empty());
    }
  };
  const std::string rubbish = dir_ / "rubbish", none = dir_ / "none", folder = dir_.path();
  const auto with = [&](std::string TlsOptions::*member, const std::string& file) {
    TlsOptions options = options_;
    options.*member = file;
    return options;
  };
  const std::pair<std::string TlsOptions::*, Kind> members[] = {
      {&TlsOptions::certificate, Kind::kCertificate},
      {&TlsOptions::key, Kind::kKey},
      {&TlsOptions::client_ca, Kind::kClientCa}};
  for (const auto& [member, kind] : members) {
    expect(with(member, rubbish), kind, rubbish, "no ");
    expect(with(member, none), kind, none, "cannot be read: No such file or directory");
    expect(with(member, folder), kind, folder, "a directory, not a regular file");
  }
  authority_.sign("other");
  expect(with(&TlsOptions::key, authority_.key("other")), Kind::kKey, authority_.key("other"),
         "no private key in PEM form that can be read, or not that of the certificate");
}

TEST_F(TlsFilesTest, EveryContextIsPrepared) {
  int prepared = 0;
  TlsFiles files(options_, [&](SSL_CTX*) { ++prepared; });
  EXPECT_EQ(prepared, 1);
  replace(options_.certificate, tests::read_file(options_.certificate));
  files.look();
  EXPECT_EQ(prepared, 2);
}

}  // namespace
}  // namespace affskel::net
