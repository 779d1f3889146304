#include "http/places.h"

#include <gtest/gtest.h>

#include <vector>

namespace affskel::http {
namespace {

using std::chrono::milliseconds;

// Connections at a clock of their own; `gone` are those that were told to close, by their numbers.
struct Room {
  explicit Room(PlaceLimits limits) : places(limits, [this] { return now; }) {}

  // Whether the newcomer found a place.
  bool come(const std::string& peer) {
    const std::size_t number = taken.size();
    taken.push_back(places.take(peer, [this, number] { gone.push_back(number); }));
    return taken.back() != nullptr;
  }

  Places::Clock::time_point now{};
  Places places;
  std::vector<std::unique_ptr<Places::Place>> taken;
  std::vector<std::size_t> gone;
};

PlaceLimits four() {
  return {.connections = 4, .for_known = 1, .of_owner = 2, .grace = milliseconds(500)};
}

TEST(Places, CountIPv6ByItsPrefixAndMappedAddressesAsIPv4) {
  const auto key = [](const char* text) { return peer_key(boost::asio::ip::make_address(text)); };
  EXPECT_EQ(key("192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(key("::ffff:192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(key("2001:db8:1:2:3:4:5:6"), key("2001:db8:1:2::1"));
  EXPECT_NE(key("2001:db8:1:2::1"), key("2001:db8:1:3::1"));
}

TEST(Places, TheSilentGoFirstThenTheIdlestThenTheBusyLongest) {
  Room room(four());
  room.come("a");  // asked, then idle
  room.taken[0]->transfers();
  room.taken[0]->idles();
  room.come("b");  // its request is on its way
  room.taken[1]->transfers();
  room.now += milliseconds(600);
  room.come("c");  // silent, but for less time than the first is idle
  room.now += milliseconds(600);
  EXPECT_TRUE(room.come("d"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{2}));
  room.taken[3]->transfers();
  EXPECT_TRUE(room.come("e"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{2, 0}));
  EXPECT_TRUE(room.come("f"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{2, 0, 1}));
}

TEST(Places, WhoHasJustComeIsNotSilentYet) {
  Room room(four());
  for (const char* peer : {"a", "b", "c"}) {
    room.come(peer);
    room.taken.back()->transfers();
    room.taken.back()->idles();
  }
  room.now += milliseconds(600);
  EXPECT_TRUE(room.come("d"));
  EXPECT_TRUE(room.come("e"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{0, 1}));
}

TEST(Places, WhoWasJustAnsweredGoesBeforeWhoHasJustCome) {
  Room room(four());
  room.come("new");
  for (const char* peer : {"b", "c"}) {
    room.now += milliseconds(20);
    room.come(peer);
    room.taken.back()->transfers();
    room.taken.back()->idles();
  }
  EXPECT_TRUE(room.come("d"));
  EXPECT_TRUE(room.come("e"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{1, 2})) << "though the first came before them";
}

TEST(Places, WhoHasJustComeIsHeardBeforeTheNextCome) {
  PlaceLimits limits = four();
  limits.stay = milliseconds(250);
  Room room(limits);
  for (const char* peer : {"a", "b", "c"}) {
    EXPECT_EQ(room.places.pause(), milliseconds(0)) << "there is room";
    room.come(peer);
    room.now += milliseconds(20);
  }
  EXPECT_EQ(room.places.pause(), milliseconds(190)) << "of the 250 of the first";
  room.now += milliseconds(190);
  EXPECT_EQ(room.places.pause(), milliseconds(0));
  room.come("d");
  EXPECT_EQ(room.places.pause(), milliseconds(20)) << "the second";
  for (std::size_t i : {1, 2, 3}) room.taken[i]->belongs_to(i == 1 ? "ada" : "eve");
  EXPECT_EQ(room.places.pause(), milliseconds(0)) << "those who are known give way as ever";
}

TEST(Places, WhoWaitsForAnAnswerGoesLast) {
  Room room(four());
  for (const char* peer : {"a", "b", "c"}) {
    room.come(peer);
    room.taken.back()->works();
    room.now += milliseconds(600);
  }
  room.taken[2]->transfers();
  EXPECT_TRUE(room.come("d"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{2}));
  room.taken.back()->works();
  EXPECT_TRUE(room.come("e"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{2, 0})) << "others may keep all places waiting";
}

TEST(Places, StrangersLeaveRoomForWhoIsKnown) {
  Room room(four());
  room.come("a");
  EXPECT_TRUE(room.taken[0]->belongs_to("ada"));
  for (const char* peer : {"b", "c", "d"}) EXPECT_TRUE(room.come(peer));
  EXPECT_TRUE(room.gone.empty());
  // However many strangers come, and however idle the known one is.
  for (int i = 0; i < 20; ++i) {
    room.now += milliseconds(600);
    EXPECT_TRUE(room.come("x" + std::to_string(i)));
    EXPECT_EQ(room.places.size(), 4U);
  }
  EXPECT_EQ(room.gone.size(), 20U);
  EXPECT_EQ(std::count(room.gone.begin(), room.gone.end(), 0U), 0);
}

TEST(Places, StrangersAtOneAddressHaveHalfOfThemWhileOthersAreThere) {
  Room room(four());
  room.come("quiet");
  room.now += milliseconds(600);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(room.come("loud"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{1, 2, 3}));
}

TEST(Places, OnePersonHasAShareOfThem) {
  Room room(four());
  for (int i = 0; i < 3; ++i) room.come("a");
  EXPECT_TRUE(room.taken[0]->belongs_to("ada"));
  EXPECT_TRUE(room.taken[1]->belongs_to("ada"));
  room.taken[0]->works();
  room.taken[1]->transfers();
  EXPECT_FALSE(room.taken[2]->belongs_to("ada")) << "both are used";
  room.taken[1]->idles();
  room.now += milliseconds(600);
  EXPECT_TRUE(room.taken[2]->belongs_to("ada"));
  EXPECT_EQ(room.gone, (std::vector<std::size_t>{1}));
}

TEST(Places, AreGivenBack) {
  Room room(four());
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(room.come("a"));
    room.taken.back()->works();
    room.taken.back().reset();
  }
  EXPECT_EQ(room.places.size(), 0U);
}

}  // namespace
}  // namespace affskel::http
