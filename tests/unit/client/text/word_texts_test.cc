#include "client/text/word_texts.h"

#include <gtest/gtest.h>

#include "client/text/words.h"

namespace affskel::client {
namespace {

using Words = std::vector<std::string>;

Words words_of(const nlohmann::ordered_json& texts) {
  Words words;
  for (const auto& [word, text] : texts.items()) words.push_back(word);
  return words;
}

TEST(WordTexts, HaveEveryWordInTheProtocolsOrder) {
  EXPECT_EQ(words_of(word_texts()), (Words{"states", "stages", "operators", "frames", "minima"}));
  EXPECT_EQ(words_of(word_texts()["states"]), state_words());
  EXPECT_EQ(words_of(word_texts()["operators"]), operator_words());
  EXPECT_EQ(words_of(word_texts()["frames"]), frame_words());
  EXPECT_EQ(words_of(word_texts()["minima"]), minimum_words());
  EXPECT_EQ(words_of(word_texts()["stages"]), (Words{"prepare", "erode", "refine", "derive", "complete"}));
}

// One that the protocol gains needs a row in word_texts.cc.
TEST(WordTexts, TellMoreThanTheWordsOfChoices) {
  const nlohmann::ordered_json texts = word_texts();
  for (const char* kind : {"stages", "operators", "frames", "minima"}) {
    for (const auto& [word, text] : texts[kind].items()) {
      EXPECT_TRUE(text != word || word == "complete") << word;
    }
  }
  EXPECT_EQ(texts["states"]["queued"], "waiting");
}

}  // namespace
}  // namespace affskel::client
