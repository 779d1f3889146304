#include "calls/status.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <cerrno>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

#include "database/errors.h"
#include "database/sqlite.h"
#include "tools/temporary_directory.h"

namespace affskel::server {
namespace {

template <typename Error>
grpc::StatusCode code_of(const Error& error) {
  return status_of(std::make_exception_ptr(error)).error_code();
}

TEST(StatusTest, EveryErrorHasItsCode) {
  using Code = StoreError::Code;
  EXPECT_EQ(code_of(StoreError(Code::kInvalid, "")), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code_of(StoreError(Code::kNotFound, "")), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(code_of(StoreError(Code::kExists, "")), grpc::StatusCode::ALREADY_EXISTS);
  EXPECT_EQ(code_of(StoreError(Code::kPrecondition, "")), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(code_of(StoreError(Code::kFenced, "")), grpc::StatusCode::ABORTED);
  EXPECT_EQ(code_of(StoreError(Code::kLimit, "")), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(code_of(SqliteError(SQLITE_FULL, "")), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(code_of(StoreError(Code::kDamaged, "")), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(code_of(StoreError(Code::kLost, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_IOERR_FSYNC, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_IOERR_WRITE, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_READONLY, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_IOERR_READ, "")), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(code_of(SqliteError(SQLITE_CORRUPT, "")), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(code_of(SqliteError(SQLITE_MISUSE, "")), grpc::StatusCode::INTERNAL);
  EXPECT_EQ(code_of(SqliteError(SQLITE_BUSY, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(std::bad_alloc()), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(code_of(std::runtime_error("")), grpc::StatusCode::INTERNAL);
  EXPECT_TRUE(guarded([] {}).ok());
}

TEST(StatusTest, DamageIsForTheLog) {
  std::ostringstream lines;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(lines)));
  code_of(StoreError(StoreError::Code::kDamaged, "row 7"));
  spdlog::set_default_logger(before);
  EXPECT_NE(lines.str().find("event=damaged message=\"row 7\""), std::string::npos) << lines.str();
}

TEST(StatusTest, StatementsAndPathsAreNotForClients) {
  for (const int code : {SQLITE_CORRUPT, SQLITE_BUSY, SQLITE_IOERR_READ, SQLITE_NOMEM, SQLITE_TOOBIG}) {
    const SqliteError error(code, "database /home/me/affskel.db: statement SELECT 1");
    const grpc::Status status = status_of(std::make_exception_ptr(error));
    EXPECT_EQ(status.error_message().find("SELECT"), std::string::npos) << status.error_message();
    EXPECT_EQ(status.error_message().find("/home"), std::string::npos) << status.error_message();
    EXPECT_FALSE(status.error_message().empty());
  }
}

TEST(StatusTest, LongMessagesAreCutAtACharacter) {
  const std::string quoted = "x" + [] {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += "\xC3\xB6";
    return text;
  }();
  const std::string message =
      status_of(std::make_exception_ptr(StoreError(StoreError::Code::kInvalid, quoted))).error_message();
  EXPECT_LT(message.size(), 2000U);
  ASSERT_TRUE(message.ends_with("..."));
  EXPECT_EQ((message.size() - 4) % 2, 0U);  // x, whole characters of two bytes, the dots
  EXPECT_EQ(
      status_of(std::make_exception_ptr(StoreError(StoreError::Code::kInvalid, "short"))).error_message(),
      "short");
}

int out_of_files(const char*, int, int) {
  errno = EMFILE;
  return -1;
}

TEST(OutOfFilesTest, IsNoErrorOfTheDatabaseButOneToTryAgain) {
  const tests::TemporaryDirectory directory;
  const std::string file = (directory.path() / "db").string();
  Database(file, Database::Mode::kReadWrite).execute("CREATE TABLE t (a INTEGER) STRICT");
  sqlite3_vfs* const vfs = sqlite3_vfs_find(nullptr);
  vfs->xSetSystemCall(vfs, "open", reinterpret_cast<sqlite3_syscall_ptr>(out_of_files));
  const grpc::Status status = guarded([&] { const Database refused(file, Database::Mode::kReadOnly); });
  vfs->xSetSystemCall(vfs, nullptr, nullptr);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(status.error_message().find(file), std::string::npos) << status.error_message();
}

}  // namespace
}  // namespace affskel::server
