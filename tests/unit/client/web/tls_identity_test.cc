#include "client/web/tls_identity.h"

#include <gtest/gtest.h>

#include "client/base/error.h"
#include "tools/files.h"
#include "tools/http_peer.h"
#include "tools/temporary_directory.h"
#include "tools/test_authority.h"

namespace affskel::client {
namespace {

class TlsIdentityTest : public ::testing::Test {
 protected:
  TlsIdentityTest() { authority_.sign("web"); }
  std::string certificate() const { return authority_.certificate("web"); }
  std::string key() const { return authority_.key("web"); }

  tests::TemporaryDirectory dir_;
  tests::TestAuthority authority_{dir_.path(), "authority"};
};

TEST_F(TlsIdentityTest, KnowsItsNames) {
  const TlsIdentity identity(certificate(), key());
  for (const char* own : {"localhost", "127.0.0.1"}) EXPECT_TRUE(identity.names(own)) << own;
  for (const char* other : {"example", "localhost.evil.example", "127.0.0.2", ""})
    EXPECT_FALSE(identity.names(other)) << other;
}

TEST_F(TlsIdentityTest, ServesOverTlsAndNotWithout) {
  TlsIdentity identity(certificate(), key());
  http::RunningServer server(
      [](const http::Request& head) -> std::variant<http::Response, http::Reception> {
        return http::Response{200, {}, head.secure ? "secure" : "open", {}, {}};
      },
      {}, [&] { return identity.context(); });
  http::Peer peer(server.port(), true);
  ASSERT_TRUE(peer.send(http::get("/")));
  EXPECT_EQ(peer.read().body, "secure");
  http::Peer plain(server.port());
  plain.send(http::get("/"));
  plain.wait_for_end();
}

TEST_F(TlsIdentityTest, TakesARenewedCertificateWithoutARestart) {
  TlsIdentity identity(certificate(), key());
  const auto before = identity.context();
  EXPECT_EQ(identity.context(), before);
  authority_.sign("web");
  std::filesystem::last_write_time(certificate(),
                                   std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_NE(identity.context(), before);
  const auto renewed = identity.context();
  tests::write_file(certificate(), "half a file");
  EXPECT_EQ(identity.context(), renewed) << "what cannot be used is passed over";
}

TEST_F(TlsIdentityTest, SaysWhatIsWrong) {
  const auto message = [](const std::string& certificate_file, const std::string& key_file) {
    try {
      const TlsIdentity identity(certificate_file, key_file);
    } catch (const ClientError& error) {
      EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
      return error.for_people();
    }
    return std::string();
  };
  EXPECT_NE(message(dir_ / "none", key()).find("none: is no certificate"), std::string::npos);
  tests::write_file(dir_ / "text", "text");
  EXPECT_NE(message(certificate(), dir_ / "text").find("text: is no private key"), std::string::npos);
  authority_.sign("other");
  EXPECT_NE(message(certificate(), authority_.key("other")).find("other.key: is no private key"),
            std::string::npos);
}

}  // namespace
}  // namespace affskel::client
