#include "access/token.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "database/migrate.h"
#include "expect_store_error.h"
#include "store_fixture.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

class TokenTest : public testing::Test {
 protected:
  TokenTest() : db_((directory_.path() / "t.db").string(), Database::Mode::kReadWrite) { migrate(db_); }

  TemporaryDirectory directory_;
  Database db_;
};

TEST(NewToken, Has256BitsInBase64Url) {
  std::set<std::string> tokens;
  std::set<char> digits;
  for (int i = 0; i < 200; ++i) {
    const std::string token = new_token();
    ASSERT_EQ(token.size(), 8u + 43u);
    ASSERT_EQ(token.substr(0, 8), "affskel_");
    for (char c : token.substr(8)) digits.insert(c);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 200u);
  EXPECT_EQ(digits.size(), 64u);  // 8600 digits: each of 64 is missing with a chance of 1e-57
}

TEST_F(TokenTest, OnlyTheHashIsStored) {
  const std::string token = new_token();
  add_token(db_, token, "ada", v1::ROLE_USER, 1000, std::nullopt);
  Statement row = db_.query("SELECT * FROM tokens");
  ASSERT_TRUE(row.step());
  bool hashed = false;
  for (int column = 0; column < 8; ++column) {
    EXPECT_EQ(row.text(column).find(token.substr(8)), std::string::npos);
    hashed = hashed || row.text(column) == wire::sha256_hex(token);
  }
  EXPECT_TRUE(hashed);
}

TEST_F(TokenTest, IsFoundByItselfAlone) {
  const std::string token = new_token();
  const std::int64_t id = add_token(db_, token, "ada", v1::ROLE_WORKER, 1000, 5000);
  const std::optional<TokenRow> found = find_token(db_, token);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->id, id);
  EXPECT_EQ(found->owner, "ada");
  EXPECT_EQ(found->role, v1::ROLE_WORKER);
  EXPECT_EQ(found->created_ms, 1000);
  EXPECT_EQ(found->expires_ms, 5000);
  EXPECT_FALSE(found->revoked_ms);
  EXPECT_FALSE(find_token(db_, token + "x"));
  EXPECT_FALSE(find_token(db_, ""));
}

TEST_F(TokenTest, ExpiresAtItsTimeAndNotBefore) {
  const std::int64_t id = add_token(db_, "t", "ada", v1::ROLE_USER, 1000, 5000);
  EXPECT_TRUE(find_token(db_, "t")->is_valid(4999));
  EXPECT_FALSE(find_token(db_, "t")->is_valid(5000));
  EXPECT_TRUE(has_valid_token(db_, 4999));
  EXPECT_FALSE(has_valid_token(db_, 5000));
  EXPECT_EQ(invalid_tokens(db_, {id}, 4999), std::vector<std::int64_t>{});
  EXPECT_EQ(invalid_tokens(db_, {id}, 5000), std::vector<std::int64_t>{id});
}

TEST_F(TokenTest, RevokedForEverAndStillListed) {
  EXPECT_FALSE(has_tokens(db_));
  const std::int64_t id = add_token(db_, "t", "ada", v1::ROLE_USER, 1000, std::nullopt);
  revoke_token(db_, id, 2000);
  revoke_token(db_, id, 3000);
  EXPECT_EQ(find_token(db_, "t")->revoked_ms, 2000);
  EXPECT_FALSE(has_valid_token(db_, 2500));
  EXPECT_TRUE(has_tokens(db_)) << "a server does not fall open when its last token is revoked";
  EXPECT_EQ(list_tokens(db_).size(), 1u);
  EXPECT_STORE_ERROR(revoke_token(db_, id + 1, 2000), kNotFound);
}

TEST_F(TokenTest, RefusesNamesThatCannotBeShown) {
  for (const char* owner : {"", "a\nb", "\xff", "\x7f", " ", "ada ", " ada", "a\u200Bda", "ada\u202E",
                            "a\u2028b", "ada\uFEFF", "a\u00A0b"}) {
    EXPECT_STORE_ERROR(add_token(db_, "t", owner, v1::ROLE_USER, 0, std::nullopt), kInvalid);
  }
  EXPECT_STORE_ERROR(add_token(db_, "t", std::string(101, 'a'), v1::ROLE_USER, 0, std::nullopt), kInvalid);
  EXPECT_FALSE(has_tokens(db_));
  for (const char* owner : {"ada lovelace", "Zo\u00EB", "\u5F20\u4E09", "a=\"b\""})
    EXPECT_NO_THROW(add_token(db_, owner, owner, v1::ROLE_USER, 0, std::nullopt)) << owner;
}

TEST_F(TokenTest, RefusesOwnersThatLookLikeAnother) {
  const auto add = [&](const char* owner) { add_token(db_, owner, owner, v1::ROLE_USER, 0, std::nullopt); };
  add("ada");
  add("Zo\u00EB");
  for (const char* owner : {"\u0430d\u0430", "\u0430\u0501\u0430", "ad\u0430", "Zoe\u0308", "a\u3164da",
                            "a\u034Fda", "\u2800ada", "ada\u2800"}) {
    SCOPED_TRACE(owner);
    EXPECT_STORE_ERROR(add(owner), kInvalid);
  }
  EXPECT_EQ(list_tokens(db_).size(), 2u);
  EXPECT_NO_THROW(add_token(db_, "another", "ada", v1::ROLE_WORKER, 0, std::nullopt)) << "the same owner";
  EXPECT_NO_THROW(add("Ada"));
  EXPECT_NO_THROW(add("\u0438\u0432\u0430\u043D"));
}

}  // namespace
}  // namespace affskel::server
