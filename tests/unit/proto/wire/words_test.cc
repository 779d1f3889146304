#include "wire/words.h"

#include <gtest/gtest.h>

#include "affskel/v1/types.pb.h"
#include "affskel/v1/worker_service.pb.h"

namespace affskel::wire {
namespace {

TEST(Words, AreNamesWithoutTheirTypes) {
  EXPECT_EQ(word(v1::JOB_STATE_QUEUED), "queued");
  EXPECT_EQ(word(v1::TASK_KIND_ERODED_POINTS), "eroded-points");
  EXPECT_EQ(word(v1::OPERATOR_ZUCKER_HUMMEL), "zucker-hummel");
  EXPECT_EQ(word(v1::OPERATOR_UNSPECIFIED), "");
  EXPECT_EQ(word(static_cast<v1::Operator>(1000)), "");
}

TEST(Words, ReadBack) {
  const auto* type = v1::TaskKind_descriptor();
  for (int i = 1; i < type->value_count(); ++i) {
    const auto kind = static_cast<v1::TaskKind>(type->value(i)->number());
    EXPECT_EQ(value_of_word<v1::TaskKind>(word(kind)), kind);
  }
  EXPECT_EQ(value_of_word<v1::TaskKind>(""), std::nullopt);
  EXPECT_EQ(value_of_word<v1::TaskKind>("PREPARE"), std::nullopt);
}

TEST(Words, ListsAllButUnspecified) {
  EXPECT_EQ(words(*v1::Frame_descriptor()), (std::vector<std::string>{"axis", "pca", "obb", "affine"}));
}

}  // namespace
}  // namespace affskel::wire
