#include "core/curve/joined_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace affskel::core {
namespace {

// Two joints `apart` from each other, with lines of 3 steps from each, and a link of two steps between them.
struct Fork {
  std::vector<Vec3> places;
  std::vector<double> ball;
  SheetLines lines;

  explicit Fork(double apart) {
    add({0, 0, 0});
    add({apart, 0, 0});
    add({apart / 2, 0, 0});
    lines.segments = {{0, 2}, {1, 2}};
    for (const double y : {-1., 1.}) {
      leave(0, {-1, y, 0});
      leave(1, {1, y, 0});
    }
    std::sort(lines.segments.begin(), lines.segments.end());
    ball.assign(places.size(), 1);
  }

  std::vector<std::uint32_t> degrees(const SheetLines& of) const {
    std::vector<std::uint32_t> degree(of.vertices.size(), 0);
    for (const Segment& segment : of.segments)
      for (const std::uint32_t v : segment) ++degree[v];
    return degree;
  }

 private:
  void add(const Vec3& at) {
    lines.vertices.push_back(static_cast<std::uint32_t>(places.size()));
    places.push_back(at);
  }
  void leave(std::uint32_t from, const Vec3& step) {
    Vec3 at = places[from];
    for (int n = 0; n < 3; ++n) {
      at = at + step;
      add(at);
      lines.segments.push_back({from, static_cast<std::uint32_t>(places.size() - 1)});
      from = static_cast<std::uint32_t>(places.size() - 1);
    }
  }
};

std::size_t count(const std::vector<std::uint32_t>& degrees, std::uint32_t which) {
  return static_cast<std::size_t>(std::count(degrees.begin(), degrees.end(), which));
}

// Of equal balls the joint nearer to the middle stays, whatever the numbers are, so that a mirror image has the mirror
// image.
TEST(JoinedLinks, NumbersDoNotTellWhichStays) {
  for (const bool turned : {false, true}) {
    Fork fork(1.25);
    if (turned)
      for (Vec3& place : fork.places) place.x = 1.25 - place.x;
    const Vec3 stays = turned ? Vec3{} : Vec3{1.25, 0, 0};
    for (Vec3& place : fork.places)  // the lines of the one that stays are longer
      if (place.x < 0 ? turned : place.x > 1.25 && !turned) place.x *= 3;
    const SheetLines joined = joined_links(fork.lines, fork.places, fork.ball);
    const std::vector<std::uint32_t> degrees = fork.degrees(joined);
    ASSERT_EQ(count(degrees, 4), 1U);
    const auto joint = std::find(degrees.begin(), degrees.end(), 4U) - degrees.begin();
    EXPECT_EQ(norm(fork.places[joined.vertices[static_cast<std::size_t>(joint)]] - stays), 0) << turned;
  }
}

TEST(JoinedLinks, JointsInEachOthersBallsBecomeOne) {
  Fork fork(1.25);  // less than 1.3 times the smaller ball
  fork.ball[1] = 1.5;
  const SheetLines joined = joined_links(fork.lines, fork.places, fork.ball);
  const auto degrees = fork.degrees(joined);
  EXPECT_EQ(count(degrees, 4), 1U);
  EXPECT_EQ(count(degrees, 1), 4U);
  EXPECT_EQ(joined.vertices.size(), fork.lines.vertices.size() - 2);
  EXPECT_EQ(joined.segments.size(), joined.vertices.size() - 1) << "still a tree";
  EXPECT_TRUE(std::count(joined.vertices.begin(), joined.vertices.end(), 1U))
      << "that of the larger ball stays";
  EXPECT_FALSE(std::count(joined.vertices.begin(), joined.vertices.end(), 0U));
}

TEST(JoinedLinks, JointsFartherApartStay) {
  Fork fork(1.35);
  const SheetLines joined = joined_links(fork.lines, fork.places, fork.ball);
  EXPECT_EQ(joined.vertices, fork.lines.vertices);
  EXPECT_EQ(joined.segments, fork.lines.segments);
}

// Two hind legs meet below the end of a dog's trunk, mostly within its ball; where a jar's belly begins its ball holds the handle's
// other end, too.
TEST(JoinedLinks, ALargeBallHoldsWhatHangsOnItAndNoHandle) {
  for (const bool is_handle : {false, true}) {
    Fork fork(1.35);
    fork.ball[1] = 1.5;
    if (is_handle) fork.lines.segments.push_back({5, 8});  // an end on each side
    std::sort(fork.lines.segments.begin(), fork.lines.segments.end());
    const SheetLines joined = joined_links(fork.lines, fork.places, fork.ball);
    EXPECT_EQ(count(fork.degrees(joined), 4), is_handle ? 0U : 1U);
    EXPECT_EQ(count(fork.degrees(joined), 3), is_handle ? 2U : 0U);
  }
}

TEST(JoinedLinks, ABallTwiceAsLargeHoldsWhatLiesBesideIt) {
  for (const double ball : {1.9, 2.1}) {
    Fork fork(2.2);
    fork.ball[1] = ball;
    EXPECT_EQ(count(fork.degrees(joined_links(fork.lines, fork.places, fork.ball)), 4), ball > 2 ? 1U : 0U);
  }
}

// A neck leaves an elephant's trunk between hips and shoulders, near both.
TEST(JoinedLinks, OneBetweenThemDoesNotJoinTwo) {
  Fork fork(1.6);
  fork.places[2].x = 0.75;
  fork.ball[2] = 1.1;  // which would stand for the hips
  const auto neck = static_cast<std::uint32_t>(fork.places.size());
  fork.places.push_back({0.75, 1, 0});
  fork.ball.push_back(1);
  fork.lines.vertices.push_back(neck);
  fork.lines.segments.push_back({2, neck});
  const SheetLines joined = joined_links(fork.lines, fork.places, fork.ball);
  EXPECT_EQ(count(fork.degrees(joined), 4), 1U) << "neck and hips";
  EXPECT_EQ(count(fork.degrees(joined), 3), 1U) << "shoulders";
}

// Two links between two joints: one goes, the other becomes a loop, or stays where it has no room for one.
TEST(JoinedLinks, ALoopStays) {
  for (const bool has_room : {false, true}) {
    Fork fork(0.9);
    const auto add = [&](std::uint32_t from, const Vec3& at) {
      const auto fresh = static_cast<std::uint32_t>(fork.places.size());
      fork.places.push_back(at);
      fork.ball.push_back(1);
      fork.lines.vertices.push_back(fresh);
      fork.lines.segments.push_back({from, fresh});
      return fresh;
    };
    std::uint32_t end = add(0, {0.3, 0, 2});
    if (has_room) end = add(end, {0.6, 0, 2});
    fork.lines.segments.push_back({1, end});
    std::sort(fork.lines.segments.begin(), fork.lines.segments.end());
    const SheetLines joined = joined_links(fork.lines, fork.places, fork.ball);
    EXPECT_EQ(joined.segments.size(), joined.vertices.size()) << "one loop";
    EXPECT_EQ(count(fork.degrees(joined), 6), has_room ? 1U : 0U);
    for (const auto& [a, b] : joined.segments) EXPECT_NE(a, b);
    EXPECT_EQ(std::adjacent_find(joined.segments.begin(), joined.segments.end()), joined.segments.end());
  }
}

// A handle leaves a trunk and comes back to it within one ball, which a short link crosses.
TEST(JoinedLinks, AHandleIsNoShortLink) {
  const std::vector<Vec3> places{{0, 0, 0},     {0.8, 0, 0},   {0, 0, 2},  {0.4, 0, 3}, {0.8, 0, 2},
                                 {0.3, 0.1, 0}, {0.5, 0.1, 0}, {0, -2, 0}, {0.8, -2, 0}};
  SheetLines lines;
  for (std::uint32_t v = 0; v < places.size(); ++v) lines.vertices.push_back(v);
  lines.segments = {{0, 2}, {0, 5}, {0, 7}, {1, 4}, {1, 6}, {1, 8}, {2, 3}, {3, 4}, {5, 6}};
  const SheetLines joined = joined_links(lines, places, std::vector<double>(places.size(), 1));
  EXPECT_EQ(joined.vertices, (std::vector<std::uint32_t>{0, 2, 3, 4, 7, 8})) << "the link's are gone";
  EXPECT_EQ(joined.segments.size(), joined.vertices.size()) << "one loop";
}

}  // namespace
}  // namespace affskel::core
