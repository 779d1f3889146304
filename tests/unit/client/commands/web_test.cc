#include <gtest/gtest.h>

#include "client_fixture.h"
#include "tools/test_authority.h"

namespace affskel::client {
namespace {

using WebCommandTest = ClientTest;

TEST_F(WebCommandTest, OtherMachinesNeedHttps) {
  for (const char* address : {"0.0.0.0:0", "[::]:0", "192.0.2.1:8443"}) {
    const Outcome outcome = run({"web", "--no-open", "--http", address});
    EXPECT_EQ(outcome.exit_code, 2) << address;
    EXPECT_NE(outcome.err.find("--tls-cert"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(WebCommandTest, RefusesWhatIsNoAddressOrHalfAnIdentity) {
  EXPECT_EQ(run({"web", "--http", "unix:/tmp/s"}).exit_code, 2);
  EXPECT_EQ(run({"web", "--http", "localhost"}).exit_code, 2);
  EXPECT_EQ(run({"web", "--http", ""}).exit_code, 2);
  EXPECT_EQ(run({"web", "--tls-cert", "c.pem"}).exit_code, 2);
  const Outcome missing = run({"web", "--tls-cert", dir_ / "c.pem", "--tls-key", dir_ / "k.pem"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.err.find("c.pem"), std::string::npos) << missing.err;
}

// Any visitor of the page could do what this client may.
TEST_F(WebCommandTest, IsNoDoorToAServerThatTakesEverybody) {
  const tests::TestAuthority authority(dir_.path(), "authority");
  authority.sign("web");
  const Outcome outcome = run({"web", "--no-open", "--http", "0.0.0.0:0", "--tls-cert",
                               authority.certificate("web"), "--tls-key", authority.key("web")});
  EXPECT_EQ(outcome.exit_code, 7);
  EXPECT_NE(outcome.err.find("asks nobody for a token"), std::string::npos) << outcome.err;
}

TEST_F(WebCommandTest, SaysWhenThereIsNoServer) {
  EXPECT_EQ(run({"web", "--no-open"}, "unix:" + (dir_ / "nobody")).exit_code, 5);
}

}  // namespace
}  // namespace affskel::client
