#include "client/connection/server_choice.h"

#include <gtest/gtest.h>

#include "client/base/error.h"
#include "test_environment.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

class ServerChoiceTest : public ::testing::Test {
 protected:
  void write_config(const std::string& text) {
    std::filesystem::create_directories(dir_.path() / "affskel");
    tests::write_file(dir_.path() / "affskel" / "config", text);
  }
  Environment environment(const std::string& server = "") {
    return test_environment(
        {{"XDG_CONFIG_HOME", dir_.path()}, {"HOME", "/nowhere"}, {"AFFSKEL_SERVER", server}});
  }
  tests::TemporaryDirectory dir_;
};

TEST_F(ServerChoiceTest, OptionThenEnvironmentThenConfigThenEmbedded) {
  EXPECT_TRUE(choose_server("", environment()).embedded);
  write_config("# our machine\n\n  server = unix:/run/from-config.sock \r\n");
  EXPECT_EQ(choose_server("", environment()).address.path, "/run/from-config.sock");
  EXPECT_EQ(choose_server("", environment("localhost:7")).address.port, 7);
  EXPECT_EQ(choose_server("unix:/run/option.sock", environment("localhost:7")).address.path,
            "/run/option.sock");
  EXPECT_EQ(choose_server("unix:/run/option.sock", environment()).origin, "--server");
}

TEST_F(ServerChoiceTest, MalformedAddressesNameWhereTheyWereRead) {
  write_config("server = 127.0.0.1\n");
  try {
    choose_server("", environment());
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
    EXPECT_EQ(error.file(), (dir_.path() / "affskel" / "config").string());
    EXPECT_EQ(error.line(), 1u);
  }
  try {
    choose_server("", environment("nonsense"));
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_NE(std::string(error.what()).find("$AFFSKEL_SERVER"), std::string::npos);
  }
}

TEST_F(ServerChoiceTest, ValuesMayStandInQuotes) {
  write_config("server = \"unix:/run/a b.sock\"\ntoken_file = '/etc/my.token'\n");
  const ServerChoice choice = choose_server("", environment());
  EXPECT_EQ(choice.address.path, "/run/a b.sock");
  EXPECT_EQ(choice.access.token_file, "/etc/my.token");
}

TEST_F(ServerChoiceTest, ConfigErrorsHaveALine) {
  for (const char* text :
       {"\nserver unix:/x\n", "\nservr = unix:/x\n", "\nserver =\n", "\nserver = \"\"\n"}) {
    write_config(text);
    try {
      choose_server("", environment());
      FAIL() << text;
    } catch (const ClientError& error) {
      EXPECT_EQ(error.line(), 2u) << text;
      EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
    }
  }
}

TEST_F(ServerChoiceTest, FilesOfTheConfigurationGoWithItsServerAlone) {
  write_config("server = lab:7060\ntoken_file = my.token\ntls_ca = /etc/lab.pem\n");
  const ServerChoice configured = choose_server("", environment());
  EXPECT_EQ(configured.access.token_file, (dir_.path() / "affskel" / "my.token").string());
  EXPECT_EQ(configured.access.tls_ca, "/etc/lab.pem");
  EXPECT_EQ(choose_server("other:7060", environment()).access.token_file, "");
  EXPECT_EQ(choose_server("", environment("other:7060")).access.token_file, "");
}

TEST_F(ServerChoiceTest, FilesByOptionThenEnvironmentThenConfiguration) {
  write_config("server = lab:7060\ntoken_file = my.token\n");
  const Environment environment = test_environment({{"XDG_CONFIG_HOME", dir_.path()},
                                                    {"AFFSKEL_TOKEN_FILE", "/env.token"},
                                                    {"AFFSKEL_TLS_CA", "/env.pem"}});
  EXPECT_EQ(choose_server("", environment).access.token_file, "/env.token");
  wire::AccessFiles given;
  given.token_file = "given.token";
  const ServerChoice choice = choose_server("", environment, given);
  EXPECT_EQ(choice.access.token_file, "given.token");
  EXPECT_EQ(choice.access.tls_ca, "/env.pem");
}

TEST_F(ServerChoiceTest, ThePrivateServerIsShownNothing) {
  wire::AccessFiles given;
  given.token_file = "given.token";
  EXPECT_EQ(choose_server("", environment(), given).access.token_file, "");
}

TEST(ConfigFile, DefaultsToTheHomeDirectory) {
  EXPECT_EQ(config_file(test_environment({{"HOME", "/home/u"}})), "/home/u/.config/affskel/config");
  EXPECT_EQ(config_file(test_environment({{"HOME", "/home/u"}, {"XDG_CONFIG_HOME", "/c"}})),
            "/c/affskel/config");
  // The XDG specification: relative paths are to be ignored.
  EXPECT_EQ(config_file(test_environment({{"HOME", "/home/u"}, {"XDG_CONFIG_HOME", "c"}})),
            "/home/u/.config/affskel/config");
}

}  // namespace
}  // namespace affskel::client
