#include "client/web/picture_cache.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace affskel::client {
namespace {

std::shared_ptr<const Picture> picture(std::size_t bytes) {
  return std::make_shared<const Picture>(Picture{std::string(bytes, 'x'), "", {}});
}

TEST(PictureCache, TheLongestUnusedLeave) {
  PictureCache cache(100);
  cache.put("a", picture(40));
  cache.put("b", picture(40));
  EXPECT_NE(cache.find("a"), nullptr);
  cache.put("c", picture(40));
  EXPECT_EQ(cache.find("b"), nullptr) << "unused since it came";
  EXPECT_NE(cache.find("a"), nullptr);
  EXPECT_NE(cache.find("c"), nullptr);
  cache.put("large", picture(1000));
  EXPECT_NE(cache.find("large"), nullptr) << "the newest stays";
  EXPECT_EQ(cache.find("a"), nullptr);
  cache.put("d", picture(1));
  EXPECT_EQ(cache.find("large"), nullptr);
}

}  // namespace
}  // namespace affskel::client
