#include "process/token_command.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "access/token.h"
#include "database/database_file.h"
#include "database/migrate.h"
#include "process/data_dir.h"
#include "process/maintenance.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

/// The commands as they are run, on a directory that may be new.
class TokenCommandTest : public testing::Test {
 protected:
  std::string data_dir() const { return (directory_.path() / "data").string(); }

  Options options(Command command) const {
    Options result;
    result.command = command;
    result.data_dir = data_dir();
    return result;
  }
  Options adding(const std::string& owner, v1::Role role = v1::ROLE_USER) const {
    Options result = options(Command::kTokenAdd);
    result.owner = owner;
    result.role = role;
    return result;
  }
  int run(const Options& options) {
    spdlog::set_level(spdlog::level::off);  // as the program does for commands
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_maintenance(options);
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    spdlog::set_level(spdlog::level::info);
    return code;
  }
  std::optional<TokenRow> find(const std::string& token) const {
    Database db(database_file(data_dir()), Database::Mode::kReadOnly);
    return find_token(db, token);
  }

  TemporaryDirectory directory_;
  std::string out_;
  std::string err_;
};

TEST_F(TokenCommandTest, TheFirstTokenMakesTheDatabase) {
  ASSERT_EQ(run(adding("ada", v1::ROLE_ADMIN)), 0) << err_;
  ASSERT_EQ(out_.back(), '\n');
  const std::string token = out_.substr(0, out_.size() - 1);
  EXPECT_EQ(token.find_first_of(" \n"), std::string::npos) << "alone on a line";
  const std::optional<TokenRow> row = find(token);
  ASSERT_TRUE(row);
  EXPECT_EQ(row->owner, "ada");
  EXPECT_EQ(row->role, v1::ROLE_ADMIN);
  EXPECT_FALSE(row->expires_ms);
  EXPECT_EQ(err_.find(token), std::string::npos);
}

TEST_F(TokenCommandTest, DoesNotGoToAFileThatOthersMayRead) {
  const std::string file = (directory_.path() / "shared").string();
  const int before = dup(STDOUT_FILENO), shared = open(file.c_str(), O_WRONLY | O_CREAT, 0644);
  ASSERT_EQ(fchmod(shared, 0644), 0);
  dup2(shared, STDOUT_FILENO);
  testing::internal::CaptureStderr();
  const int code = run_maintenance(adding("ada"));
  const std::string said = testing::internal::GetCapturedStderr();
  dup2(before, STDOUT_FILENO);
  close(before);
  close(shared);
  EXPECT_EQ(code, 2);
  EXPECT_NE(said.find("-o FILE"), std::string::npos) << said;
  EXPECT_TRUE(std::filesystem::is_empty(file));
}

TEST_F(TokenCommandTest, ATokenThatNobodySawIsTakenBack) {
  Options to_file = adding("bob");
  to_file.output = (directory_.path() / "token").string();
  to_file.json = true;
  for (const Options& adding_one : {adding("ada"), to_file}) {
    const int before = dup(STDOUT_FILENO), full = open("/dev/full", O_WRONLY);
    dup2(full, STDOUT_FILENO);
    testing::internal::CaptureStderr();
    const int code = run_maintenance(adding_one);
    const std::string said = testing::internal::GetCapturedStderr();
    dup2(before, STDOUT_FILENO);
    std::cout.clear();
    close(before);
    close(full);
    EXPECT_EQ(code, 8);
    EXPECT_NE(said.find("cannot write to standard output: No space left on device"), std::string::npos)
        << said;
  }
  EXPECT_FALSE(std::filesystem::exists(to_file.output));
  Database db(database_file(data_dir()), Database::Mode::kReadOnly);
  EXPECT_TRUE(list_tokens(db).empty());
}

TEST_F(TokenCommandTest, WorksWhileAServerHoldsTheDirectory) {
  ASSERT_EQ(run(adding("ada")), 0);
  const DataDir held(data_dir());
  Options more = adding("bob");
  more.expires = std::chrono::hours(24);
  more.json = true;
  ASSERT_EQ(run(more), 0) << err_;
  const auto added = nlohmann::json::parse(out_);
  EXPECT_EQ(added["owner"], "bob");
  EXPECT_EQ(added["role"], "user");
  const TokenRow row = *find(added["token"]);
  EXPECT_EQ(*row.expires_ms - row.created_ms, 24 * 3600 * 1000);
  Options revoke = options(Command::kTokenRevoke);
  revoke.token = added["id"];
  EXPECT_EQ(run(revoke), 0);
  EXPECT_TRUE(find(added["token"])->revoked_ms);
}

TEST_F(TokenCommandTest, TheListHasAllButTheTokens) {
  ASSERT_EQ(run(adding("ada")), 0);
  const std::string token = out_.substr(0, out_.size() - 1);
  ASSERT_EQ(run(options(Command::kTokenList)), 0);
  EXPECT_NE(out_.find("ada"), std::string::npos);
  EXPECT_NE(out_.find("good"), std::string::npos);
  EXPECT_EQ(out_.find(token.substr(8)), std::string::npos);
  Options json = options(Command::kTokenList);
  json.json = true;
  ASSERT_EQ(run(json), 0);
  const auto listed = nlohmann::json::parse(out_);
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_EQ(listed[0]["state"], "good");
  EXPECT_TRUE(listed[0]["last_used_ms"].is_null());
}

TEST_F(TokenCommandTest, FaultsHaveTheirCodes) {
  EXPECT_EQ(run(options(Command::kTokenList)), 3) << "no database, and none is made";
  EXPECT_FALSE(std::filesystem::exists(data_dir()));
  ASSERT_EQ(run(adding("ada")), 0);
  Options revoke = options(Command::kTokenRevoke);
  revoke.token = 99;
  EXPECT_EQ(run(revoke), 4);
  EXPECT_NE(err_.find("no token 99"), std::string::npos);
  EXPECT_EQ(run(adding("a\nb")), 2);
}

// There is no way back from a migration, and nobody asked for one.
TEST_F(TokenCommandTest, AnOlderDatabaseKeepsItsSchema) {
  std::filesystem::create_directory(data_dir());
  {
    Database db(database_file(data_dir()), Database::Mode::kReadWrite);
    migrate(db, {embedded_migrations().front()});
  }
  ASSERT_EQ(run(adding("ada")), 0) << err_;
  ASSERT_EQ(run(options(Command::kTokenList)), 0) << err_;
  EXPECT_NE(out_.find("ada"), std::string::npos) << out_;
  Options revoke = options(Command::kTokenRevoke);
  revoke.token = 1;
  ASSERT_EQ(run(revoke), 0) << err_;
  ASSERT_EQ(run(options(Command::kTokenList)), 0) << err_;
  EXPECT_NE(out_.find("revoked"), std::string::npos) << out_;
  Database db(database_file(data_dir()), Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("PRAGMA user_version"), 1);
}

TEST_F(TokenCommandTest, TokensOfAnotherShapeAreRefusedWithAWayOn) {
  ASSERT_EQ(run(adding("ada")), 0);
  Database(database_file(data_dir()), Database::Mode::kReadWrite)
      .execute("ALTER TABLE tokens DROP COLUMN last_used_ms");
  for (const Command command : {Command::kTokenList, Command::kTokenRevoke}) {
    EXPECT_EQ(run(options(command)), 3);
    EXPECT_NE(err_.find("affskel-server migrate"), std::string::npos) << err_;
  }
}

}  // namespace
}  // namespace affskel::server
