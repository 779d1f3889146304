#include "base/logfmt.h"

#include <gtest/gtest.h>

#include <random>

#include "base/utf8.h"
#include "tools/logfmt_parser.h"

namespace affskel::base {
namespace {

std::map<std::string, std::string> parsed(const std::string& line) {
  return tests::LogfmtParser(line).parse();
}

TEST(LogfmtTest, PlainValuesStandBare) {
  EXPECT_EQ(logfmt("listening", {{"address", "unix:/run/a.sock"}, {"pid", 12}, {"offset", -3}}),
            "event=listening address=unix:/run/a.sock pid=12 offset=-3");
  EXPECT_EQ(logfmt("stopped"), "event=stopped");
}

TEST(LogfmtTest, OthersStandInQuotesWithEscapes) {
  EXPECT_EQ(logfmt("x", {{"a", ""}, {"b", "two words"}, {"c", "k=v"}}),
            R"(event=x a="" b="two words" c="k=v")");
  EXPECT_EQ(logfmt("x", {{"a", "say \"no\"\\\n\tend"}, {"b", std::string("\0\x1b\x7f", 3)}}),
            R"(event=x a="say \"no\"\\\n\tend" b="\u0000\u001b\u007f")");
  EXPECT_EQ(logfmt("x", {{"owner", "Zoë"}}), "event=x owner=\"Zoë\"");
}

TEST(LogfmtTest, NobodyWritesAnEntryOrAFieldOfHisOwn) {
  const std::string line =
      logfmt("failed", {{"message", "a\" level=info\nevent=done owner=root"}, {"owner", "ada"}});
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto fields = parsed(line);
  EXPECT_EQ(fields.size(), 3U);
  EXPECT_EQ(fields.at("event"), "failed");
  EXPECT_EQ(fields.at("owner"), "ada");
}

TEST(LogfmtTest, AnyBytesComeBackAsTheyWereOrAsUtf8) {
  std::mt19937 random(7);  // NOLINT: the same every time
  std::uniform_int_distribution<int> length(0, 12);
  // Mostly what needs care.
  const std::string care = "\"\\=\n\r\t \x01\x7f\x80\xc3\xa9z";
  std::uniform_int_distribution<std::size_t> pick(0, care.size() - 1);
  std::string line;
  std::map<std::string, std::string> expected;
  for (int i = 0; i < 3000; ++i) {
    std::string value;
    for (int n = length(random); n > 0; --n) value += care[pick(random)];
    const std::string key = "k" + std::to_string(i);
    append_field(line, {key, value});
    expected[key] = to_utf8(value);
  }
  EXPECT_EQ(parsed(line), expected);
}

}  // namespace
}  // namespace affskel::base
