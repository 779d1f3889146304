#include "base/exit_code.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace affskel::base {
namespace {

TEST(ExitCodeTest, EveryCodeHasItsOwnNameAndMeaning) {
  std::set<int> codes;
  std::set<std::string> names, meanings;
  for (const ExitCodeRow& row : kExitCodes) {
    codes.insert(static_cast<int>(row.code));
    names.insert(row.name);
    meanings.insert(row.meaning);
    EXPECT_STREQ(exit_code_name(row.code), row.name);
  }
  EXPECT_EQ(codes, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 70, 141})) << "scripts rely on them";
  EXPECT_EQ(names.size(), kExitCodes.size());
  EXPECT_EQ(meanings.size(), kExitCodes.size());
}

}  // namespace
}  // namespace affskel::base
