#include "client/text/portable_name.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(PortableName, HoldsNothingThatASystemForbids) {
  EXPECT_EQ(portable_name("woman ü"), "woman ü");
  EXPECT_EQ(portable_name("a/b\\c:d*e?f\"g<h>i|j\n"), "a_b_c_d_e_f_g_h_i_j_");
  EXPECT_EQ(portable_name(""), "job");
  EXPECT_EQ(portable_name(".."), "job..");
  EXPECT_EQ(portable_name("-rf"), "-rf");
  EXPECT_LE(portable_name(std::string(300, 'x')).size(), 100u);
}

}  // namespace
}  // namespace affskel::client
