#include "client/base/stance.h"

#include <gtest/gtest.h>

#include "client/base/error.h"
#include "core/shapes/body.h"

namespace affskel::client {
namespace {

constexpr core::Stance kUsual{{2, false}, {1, true}}, kOther{{1, true}, {0, false}};

TEST(Stance, IsReadAsItIsWritten) {
  for (const std::string up : {"x", "-x", "y", "-y", "z", "-z"}) {
    for (const std::string front : {"x", "-x", "y", "-y", "z", "-z"}) {
      if (up.back() == front.back()) {
        EXPECT_THROW(parse_stance(up + "," + front), ClientError);
        continue;
      }
      const StanceChoice choice = parse_stance(up + "," + front);
      ASSERT_TRUE(choice.up && choice.front) << up << front;
      EXPECT_EQ(stance_text({*choice.up, *choice.front}), up + " up, facing " + front);
    }
    EXPECT_EQ(direction_text(*parse_stance(up).up), up);
    EXPECT_FALSE(parse_stance(up).front);
  }
  EXPECT_TRUE(parse_stance("shape").by_shape);
  for (const char* wrong : {"", "up", "z,", ",z", "zz", "z,-", "z,y,x", "--z", "w"})
    EXPECT_THROW(parse_stance(wrong), ClientError) << wrong;
}

TEST(Stance, IsKeptWithAJob) {
  v1::Job job;
  EXPECT_FALSE(kept_stance(job));
  *job.mutable_stance() = stance_message(kOther);
  EXPECT_EQ(job.stance().up(), v1::AXIS_DIRECTION_MINUS_Y);
  EXPECT_EQ(job.stance().front(), v1::AXIS_DIRECTION_X);
  EXPECT_EQ(kept_stance(job), kOther);
}

TEST(Stance, ChoiceGoesBeforeWhatIsKeptAndThatBeforeTheShape) {
  const core::Mesh body = core::make_body();
  v1::Job job;
  EXPECT_EQ(stance_of({}, job, body), kUsual);
  *job.mutable_stance() = stance_message(kOther);
  EXPECT_EQ(stance_of({}, job, body), kOther);
  EXPECT_EQ(stance_of(parse_stance("shape"), job, body), kUsual);
  EXPECT_EQ(stance_of(parse_stance("x,-z"), job, body), (core::Stance{{0, false}, {2, true}}));
  EXPECT_EQ(stance_of(parse_stance("z"), job, body), kUsual);
}

}  // namespace
}  // namespace affskel::client
