#include "job/result_bytes.h"

#include <gtest/gtest.h>

#include "affskel/v1/types.pb.h"
#include "core/base/error.h"

namespace affskel::worker {
namespace {

v1::Directions three_directions() {
  v1::Directions message;
  for (int i = 0; i < 9; ++i) message.add_xyz(i);
  return message;
}

TEST(ResultBytesTest, AppendsWhatCanBeReadBack) {
  std::string result = "before";
  append_result(result, three_directions(), "the directions");
  v1::Directions back;
  ASSERT_TRUE(back.ParseFromString(result.substr(6)));
  EXPECT_EQ(back.xyz_size(), 9);
  EXPECT_EQ(back.xyz(8), 8.0);
}

TEST(ResultBytesTest, TheLimitHoldsForTheWholeResult) {
  const std::uint64_t size = three_directions().ByteSizeLong();
  std::string result = "before";
  EXPECT_NO_THROW(append_result(result, three_directions(), "the directions", 6 + size));
  result = "before";
  try {
    append_result(result, three_directions(), "the directions", 5 + size);
    FAIL() << "one byte too many was taken";
  } catch (const core::CoreError& error) {
    EXPECT_EQ(error.code(), core::CoreError::Code::kLimit);
    EXPECT_NE(std::string(error.what()).find("the directions"), std::string::npos) << error.what();
  }
  EXPECT_EQ(result, "before");
}

}  // namespace
}  // namespace affskel::worker
