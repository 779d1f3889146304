#include "traffic/frame_guard.h"

#include <gtest/gtest.h>

#include <string>

#include "tools/http2_frames.h"

namespace affskel::server {
namespace {

using namespace tests::http2;

const std::string kBlock(40, 'h');
const std::string kFour(4, '\0');  // an error's code, or a window

/// A guard that has heard the first words.
FrameGuard begun(const FrameLimits& limits = {}) {
  FrameGuard guard(limits);
  EXPECT_EQ(guard.from_client(std::string(kPreface) + frame(kSettings, 0, 0)), 1u);
  EXPECT_TRUE(guard.begun());
  return guard;
}

TEST(FrameGuardTest, FramesMayBeCutAnywhere) {
  std::string bytes(kPreface);
  bytes += frame(kSettings, 0, 0);
  bytes += frame(kHeaders, 0, 1, kBlock);
  bytes += frame(kContinuation, kEndHeaders, 1, kBlock);
  bytes += frame(kData, kEndStream, 1, std::string(1000, 'd'));
  bytes += frame(kHeaders, kEndHeaders, 3, kBlock);
  bytes += frame(kReset, 0, 3, kFour);
  for (std::size_t size = 1; size <= bytes.size(); size = size * 2 + 1) {
    FrameGuard guard;
    std::size_t cost = 0;
    for (std::size_t at = 0; at < bytes.size(); at += size) cost += guard.from_client(bytes.substr(at, size));
    EXPECT_EQ(cost, 2u) << "the settings, and a call that is taken back";
    EXPECT_EQ(guard.calls(), 2u) << size;
    EXPECT_EQ(guard.open_calls(), 1u) << size;
    EXPECT_EQ(guard.held_frames(), 2u) << size;
  }
}

TEST(FrameGuardTest, OtherProtocolsAreNotTaken) {
  FrameGuard guard;
  EXPECT_THROW(guard.from_client("GET / HTTP/1.1\r\n"), FrameFault);
  FrameGuard almost;
  almost.from_client("PRI * HTTP/2.0\r\n\r\nS");
  EXPECT_FALSE(almost.begun());
  EXPECT_THROW(almost.from_client("N"), FrameFault);
}

TEST(FrameGuardTest, AHeaderBlockHasAnEnd) {
  FrameGuard by_bytes = begun({.block_bytes = 100});
  by_bytes.from_client(frame(kHeaders, 0, 1, std::string(60, 'h')));
  EXPECT_THROW(by_bytes.from_client(frame(kContinuation, 0, 1, std::string(41, 'h'))), FrameFault);
  FrameGuard by_frames = begun({.block_frames = 3});
  by_frames.from_client(frame(kHeaders, 0, 1, "h") + frame(kContinuation, 0, 1) + frame(kContinuation, 0, 1));
  EXPECT_THROW(by_frames.from_client(frame(kContinuation, kEndHeaders, 1)), FrameFault);
  FrameGuard next = begun({.block_bytes = 100});
  for (std::uint32_t stream = 1; stream < 9; stream += 2) {
    next.from_client(frame(kHeaders, kEndHeaders, stream, std::string(100, 'h')));
  }
  EXPECT_EQ(next.open_calls(), 4u) << "each block by itself";
}

TEST(FrameGuardTest, NothingComesBetweenThePartsOfAHeaderBlock) {
  for (const std::string& between : {frame(kPing, 0, 0, "12345678"), frame(kHeaders, kEndHeaders, 3, kBlock),
                                     frame(kContinuation, kEndHeaders, 3, kBlock)}) {
    FrameGuard guard = begun();
    guard.from_client(frame(kHeaders, 0, 1, kBlock));
    EXPECT_THROW(guard.from_client(between), FrameFault);
  }
  EXPECT_THROW(begun().from_client(frame(kContinuation, kEndHeaders, 1, kBlock)), FrameFault);
}

TEST(FrameGuardTest, WhatMakesWorkCosts) {
  FrameGuard guard = begun({.calls = 2});
  EXPECT_EQ(guard.from_client(frame(kPing, 0, 0, "12345678")), 1u);
  EXPECT_EQ(guard.from_client(frame(kPing, kAck, 0, "12345678")), 0u);
  EXPECT_EQ(guard.from_client(frame(kSettings, kAck, 0)), 0u);
  EXPECT_EQ(guard.from_client(frame(kWindowUpdate, 0, 0, kFour)), 0u);
  EXPECT_EQ(guard.from_client(frame(kPriority, 0, 1, "12345")), 1u);
  EXPECT_EQ(guard.from_client(frame(0xcc, 0, 0, "unknown")), 1u);
  EXPECT_EQ(guard.from_client(frame(kHeaders, kEndHeaders, 1, kBlock)), 0u);
  EXPECT_EQ(guard.from_client(frame(kData, 0, 1)), 1u) << "empty, and not the end";
  EXPECT_EQ(guard.from_client(frame(kData, kEndStream, 1)), 0u);
  EXPECT_EQ(guard.from_client(frame(kHeaders, kEndHeaders, 3, kBlock)), 0u);
  EXPECT_EQ(guard.from_client(frame(kHeaders, kEndHeaders, 5, kBlock)), 1u) << "more than are offered";
  EXPECT_EQ(guard.from_client(frame(kReset, 0, 5, kFour)), 1u);
  EXPECT_EQ(guard.from_client(frame(kReset, 0, 5, kFour)), 0u) << "it had ended";
}

TEST(FrameGuardTest, CallsEndWithTheirAnswers) {
  FrameGuard guard = begun();
  for (const std::uint32_t stream : {1U, 3U, 5U})
    guard.from_client(frame(kHeaders, kEndHeaders, stream, kBlock));
  guard.from_server(frame(kHeaders, kEndHeaders, 1, kBlock) + frame(kData, 0, 1, std::string(500, 'd')));
  EXPECT_EQ(guard.open_calls(), 3u);
  guard.from_server(frame(kHeaders, kEndHeaders | kEndStream, 1, kBlock));
  guard.from_server(frame(kData, kEndStream, 3, "dd"));
  EXPECT_EQ(guard.open_calls(), 1u);
  EXPECT_EQ(guard.held_frames(), 1u);
  EXPECT_EQ(guard.answered(), 502u);
  EXPECT_EQ(guard.from_client(frame(kReset, 0, 1, kFour)), 0u) << "too late to make work";
}

TEST(FrameGuardTest, CallsThatTheServerTakesBackCostTheClient) {
  FrameGuard guard = begun();
  for (const std::uint32_t stream : {1U, 3U, 5U})
    guard.from_client(frame(kHeaders, kEndHeaders, stream, kBlock));
  guard.from_server(frame(kReset, 0, 1, kFour) + frame(kReset, 0, 3, kFour));
  EXPECT_EQ(guard.from_client(frame(kData, kEndStream, 5)), 2u);
  guard.from_server(frame(kHeaders, kEndHeaders | kEndStream, 5, kBlock) + frame(kReset, 0, 5, kFour));
  EXPECT_EQ(guard.from_client(frame(kPing, kAck, 0, "12345678")), 0u) << "after the answer it is no fault";
}

TEST(FrameGuardTest, HeadersOfCallsUnderWayAreBounded) {
  FrameGuard guard = begun({.held_frames = 3});
  guard.from_client(frame(kHeaders, 0, 1, kBlock) + frame(kContinuation, kEndHeaders, 1, kBlock));
  guard.from_client(frame(kHeaders, kEndHeaders, 3, kBlock));
  guard.from_server(frame(kHeaders, kEndHeaders | kEndStream, 3, kBlock));
  guard.from_client(frame(kHeaders, kEndHeaders, 5, kBlock));
  EXPECT_THROW(guard.from_client(frame(kHeaders, kEndHeaders, 7, kBlock)), FrameFault);
}

TEST(FrameGuardTest, CrumbsOfMessagesAreBoundedUntilTheyAreRead) {
  FrameGuard guard = begun({.held_frames = 4});
  guard.from_client(frame(kHeaders, kEndHeaders, 1, kBlock) + frame(kHeaders, kEndHeaders, 3, kBlock));
  guard.from_client(frame(kData, 0, 1, "d") + frame(kData, 0, 3, std::string(127, 'd')));
  guard.from_client(frame(kData, 0, 3, std::string(128, 'd')) + frame(kData, kEndStream, 3, "d"));
  EXPECT_EQ(guard.held_frames(), 4u) << "what is long, and the last of a call, is not held for itself";
  guard.from_server(frame(kWindowUpdate, 0, 0, kFour));
  EXPECT_EQ(guard.held_frames(), 4u) << "it says nothing of one call";
  guard.from_server(frame(kWindowUpdate, 0, 1, kFour));
  EXPECT_EQ(guard.held_frames(), 3u);
  guard.from_server(frame(kHeaders, kEndHeaders | kEndStream, 3, kBlock));
  EXPECT_EQ(guard.held_frames(), 1u);
  guard.from_client(frame(kData, 0, 3, "late"));
  EXPECT_EQ(guard.held_frames(), 1u);
  guard.from_client(frame(kData, 0, 1, "d") + frame(kData, 0, 1, "d") + frame(kData, 0, 1, "d"));
  EXPECT_THROW(guard.from_client(frame(kData, 0, 1, "d")), FrameFault);
}

}  // namespace
}  // namespace affskel::server
