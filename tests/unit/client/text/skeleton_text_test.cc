#include "client/text/skeleton_text.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace affskel::client {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

Lines with(const Lines& lines, const std::string& key) {
  Lines result;
  for (const auto& line : lines)
    if (line.first == key) result.push_back(line);
  return result;
}

TEST(QualityLines, NamePlacesThatTheLatticeIsTooCoarseFor) {
  v1::SkeletonQuality quality;
  quality.set_points(10);
  quality.set_unreached_ends(3);
  v1::CoarsePlace& end = *quality.add_unreached();
  end.set_x(1.5);
  end.set_y(-2);
  end.set_z(1000.25);
  end.set_size(12.345);
  v1::CoarsePlace& tunnel = *quality.add_tunnels();
  tunnel.set_size(40);
  const Lines lines = quality_lines(quality);
  EXPECT_EQ(
      with(lines, "unreached"),
      (Lines{{"unreached", "at (1.5, -2, 1000), the skeleton ends 12.35 away: thinner than the spacing"},
             {"unreached", "2 more ends, nearer to the skeleton"}}));
  EXPECT_EQ(with(lines, "tunnel"),
            (Lines{{"tunnel", "at (0, 0, 0), 40 across: not the solid's, the lattice is too coarse there"}}));
}

TEST(QualityLines, NameThePlacesWhereClosedSurfacesWereOpened) {
  v1::SkeletonQuality quality;
  quality.set_points(10);
  quality.set_opened(1);
  v1::CoarsePlace& opening = *quality.add_openings();
  opening.set_z(0.5);
  opening.set_size(0.25);
  EXPECT_EQ(with(quality_lines(quality), "opened"),
            (Lines{{"opened", "1 closed surface: a cavity has no line round it"},
                   {"opened", "at (0, 0, 0.5), where E is least, 0.25 from the surface"}}));
}

TEST(QualityLines, SayNothingOfThatWhereTheLatticeIsFineEnough) {
  v1::SkeletonQuality quality;
  quality.set_points(10);
  EXPECT_TRUE(with(quality_lines(quality), "unreached").empty());
  EXPECT_TRUE(with(quality_lines(quality), "tunnel").empty());
}

}  // namespace
}  // namespace affskel::client
