#include "wire/channel.h"

#include <gtest/gtest.h>
#include <sys/prctl.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace affskel::wire {
namespace {

class ChannelTest : public testing::Test {
 protected:
  ChannelTest() {
    std::string name = (std::filesystem::temp_directory_path() / "affskel-channel-XXXXXX").string();
    directory_ = mkdtemp(name.data());
  }
  ~ChannelTest() override { std::filesystem::remove_all(directory_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(directory_ / name) << text;
    return (directory_ / name).string();
  }
  /// What making the channel says; "" = it was made.
  static std::string error_of(const char* address, const AccessFiles& files) {
    try {
      make_channel(parse_address(address), files, {});
      return {};
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }

  std::filesystem::path directory_;
};

TEST_F(ChannelTest, FilesThatAreNoGoodAreNamed) {
  const std::string rubbish = write("rubbish", "rubbish\n");
  const std::string absent = (directory_ / "absent").string();
  for (const std::string& file : {rubbish, absent}) {
    AccessFiles files;
    files.tls_ca = file;
    EXPECT_NE(error_of("lab:1", files).find(file), std::string::npos) << error_of("lab:1", files);
  }
  for (const char* text : {"", "\nsecret\n", "sec ret\n", "secret\x01\n", "secret\xc3\xb6\n"}) {
    AccessFiles files;
    files.token_file = write("token", text);
    const std::string error = error_of("unix:/s", files);
    EXPECT_NE(error.find(files.token_file), std::string::npos) << text;
    EXPECT_EQ(error.find("sec"), std::string::npos) << "nothing of it is told: " << error;
  }
  AccessFiles alone;
  alone.tls_ca = write("ca", "-----BEGIN CERTIFICATE-----\n");
  alone.tls_cert = alone.tls_ca;
  EXPECT_NE(error_of("lab:1", alone).find("go together"), std::string::npos);
}

TEST_F(ChannelTest, ACertificateInPemFormThatIsNoneIsNamed) {
  AccessFiles files;
  files.tls_ca = write("ca", "-----BEGIN CERTIFICATE-----\nbm9uZQ==\n-----END CERTIFICATE-----\n");
  EXPECT_EQ(error_of("lab:1", files), files.tls_ca + ": no certificate in PEM form that can be read");
}

TEST_F(ChannelTest, ATokenDoesNotLeaveTheMachineInTheClear) {
  AccessFiles files;
  files.token_file = write("token", "affskel_x\n");
  EXPECT_NE(error_of("lab.example.org:1", files).find("in the clear"), std::string::npos);
  EXPECT_EQ(error_of("127.0.0.1:1", files), "");
  EXPECT_EQ(error_of("unix:/s", files), "");
}

TEST_F(ChannelTest, WhoHoldsATokenLeavesNoCoreDump) {
  prctl(PR_SET_DUMPABLE, 1);
  ASSERT_EQ(error_of("unix:/s", {}), "");
  EXPECT_EQ(prctl(PR_GET_DUMPABLE), 1);
  AccessFiles files;
  files.token_file = write("token", "affskel_x\n");
  ASSERT_EQ(error_of("unix:/s", files), "");
  EXPECT_EQ(prctl(PR_GET_DUMPABLE), 0);
  prctl(PR_SET_DUMPABLE, 1);
}

}  // namespace
}  // namespace affskel::wire
