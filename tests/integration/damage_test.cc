// Bits that flip in the database file under a live server: none is served, all are found and mended.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "lab.h"

namespace affskel::integration {
namespace {

constexpr int kFlips = 12;
constexpr std::size_t kRecordBytes = 20;

class DamageTest : public testing::Test {
 protected:
  void SetUp() override {
    lab_.make_torus(512);
    server_.emplace(lab_.server());
    worker_.emplace(lab_.worker());
    id_ = lab_.submit({"--points", "20000", "--directions", "sphere:300"});
    ASSERT_EQ(lab_.follow_to_end(id_).state(), v1::JOB_STATE_DONE);
    field_ = fetch_bytes();
    ASSERT_GT(field_.size(), std::size_t{kFlips} * kRecordBytes);
    // The log is copied into the file when the last connection closes.
    restart();
  }

  void restart() {
    server_->send(SIGTERM);
    EXPECT_EQ(server_->wait(), 0);
    server_.emplace(lab_.server());
  }

  /// The field as it comes over the wire; "" when it does not.
  std::string fetch_bytes() const {
    v1::FetchArtifactRequest request;
    request.set_job(id_);
    request.set_kind(v1::ARTIFACT_KIND_FIELD);
    grpc::ClientContext context;
    const auto reader = lab_.stub().FetchArtifact(&context, request);
    v1::FetchArtifactResponse response;
    std::string bytes;
    while (reader->Read(&response)) bytes += response.data();
    return reader->Finish().ok() ? bytes : std::string();
  }

  Output check(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments = {AFFSKEL_SERVER_BINARY, "check", "--data-dir", lab_.path("data")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return lab_.run(arguments);
  }

  /// Where a record of the field, or one of the next, lies in the file.  Two in a row: reports that were
  /// merged may still lie about.  The next, for pages end between records or within one.
  std::size_t place_of(std::size_t record) const {
    const std::string file = lab_.read("data/affskel.db");
    std::size_t at = std::string::npos;
    for (std::size_t i = record; i < record + 4 && at == std::string::npos; ++i) {
      at = file.find(field_.substr(i * kRecordBytes, 2 * kRecordBytes));
    }
    EXPECT_NE(at, std::string::npos);
    return at;
  }

  void flip(std::size_t at, int bit) const {
    std::fstream file(lab_.path("data/affskel.db"), std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(static_cast<std::streamoff>(at));
    const auto byte = static_cast<char>(file.get() ^ (1 << bit));
    file.seekp(static_cast<std::streamoff>(at));
    file.put(byte);
  }

  Lab lab_;
  std::optional<Process> server_;
  std::optional<Process> worker_;
  std::string id_;
  std::string field_;
};

TEST_F(DamageTest, NoFlippedBitOfALiveFieldIsServedAndEveryOneIsFound) {
  const std::size_t records = field_.size() / kRecordBytes;
  for (std::size_t i = 0; i < kFlips; ++i) {
    const std::size_t at = place_of(i * (records - 5) / (kFlips - 1)) + i % kRecordBytes;
    flip(at, static_cast<int>(i % 8));
    const Output found = check();
    EXPECT_EQ(found.exit_code, 1);
    EXPECT_NE(found.err.find("does not match its checksum"), std::string::npos) << found.err;
    EXPECT_NE(found.err.find("must be computed again"), std::string::npos) << found.err;
    const Output fetched = lab_.client({"fetch", id_, "field", "-o", lab_.path("bad.csv")});
    EXPECT_EQ(fetched.exit_code, 4) << fetched.err;
    EXPECT_NE(fetched.err.find("check --repair"), std::string::npos) << fetched.err;
    flip(at, static_cast<int>(i % 8));
  }
  EXPECT_EQ(check().exit_code, 0);
  EXPECT_TRUE(fetch_bytes() == field_);
}

TEST_F(DamageTest, ARepairHasTheFieldComputedAgain) {
  flip(place_of(100), 3);
  EXPECT_EQ(check({"--repair"}).exit_code, 7) << "refused beside a server";
  server_->send(SIGTERM);
  EXPECT_EQ(server_->wait(), 0);
  const Output repaired = check({"--repair"});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
  EXPECT_NE(repaired.err.find("repaired: "), std::string::npos) << repaired.err;
  server_.emplace(lab_.server());
  ASSERT_EQ(lab_.follow_to_end(id_).state(), v1::JOB_STATE_DONE);
  EXPECT_TRUE(fetch_bytes() == field_) << "the fields differ";
}

// It ends at once, for what it would acknowledge could not be kept.
TEST_F(DamageTest, TheServerLeavesWhenItsDatabaseIsTakenAway) {
  ASSERT_EQ(std::rename(lab_.path("data/affskel.db").c_str(), lab_.path("away.db").c_str()), 0);
  EXPECT_EQ(server_->wait(), 2);
  EXPECT_NE(lab_.read("server.log").find("event=database_lost"), std::string::npos);
  EXPECT_EQ(lab_.run({AFFSKEL_SERVER_BINARY, "--data-dir", lab_.path("data")}).exit_code, 2);
}

}  // namespace
}  // namespace affskel::integration
