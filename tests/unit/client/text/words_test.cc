#include "client/text/words.h"

#include <gtest/gtest.h>

#include "client/base/error.h"

namespace affskel::client {
namespace {

using Words = std::vector<std::string>;

TEST(Words, AreThoseOfTheCommandLine) {
  EXPECT_EQ(state_words(), (Words{"queued", "running", "done", "failed", "cancelled"}));
  EXPECT_EQ(frame_words(), (Words{"axis", "pca", "obb", "affine"}));
  EXPECT_EQ(operator_words(),
            (Words{"zucker-hummel", "intermediate", "central", "sobel", "flux", "chords", "ridge", "curve"}));
}

TEST(Words, LeadBackToTheirValues) {
  for (const std::string& word : state_words()) EXPECT_EQ(state_word(state_named(word)), word);
  for (const std::string& word : frame_words()) EXPECT_EQ(frame_word(frame_named(word)), word);
  for (const std::string& word : operator_words()) EXPECT_EQ(operator_word(operator_named(word)), word);
}

TEST(Words, OnlyWhatIsNotSpecifiedIsTheDefault) {
  EXPECT_EQ(frame_word(v1::FRAME_UNSPECIFIED), "axis");
  EXPECT_EQ(operator_word(v1::OPERATOR_UNSPECIFIED), "ridge");
  EXPECT_EQ(state_word(v1::JOB_STATE_UNSPECIFIED), "unknown");
  EXPECT_EQ(state_word(static_cast<v1::JobState>(99)), "unknown");
  EXPECT_EQ(stage_word(static_cast<v1::JobStage>(99)), "unknown");
  EXPECT_EQ(frame_word(static_cast<v1::Frame>(99)), "unknown");
  EXPECT_EQ(operator_word(static_cast<v1::Operator>(99)), "unknown");
}

TEST(Words, AnUnknownOneIsRefusedNamingThePossible) {
  for (const std::string word : {"", "Sobel", "unspecified"}) {
    try {
      operator_named(word);
      ADD_FAILURE() << word;
    } catch (const ClientError& error) {
      EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
      EXPECT_NE(std::string(error.what()).find("sobel, flux, chords, ridge"), std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(state_named("unknown"), ClientError);
  EXPECT_THROW(frame_named("unknown"), ClientError);
}

}  // namespace
}  // namespace affskel::client
