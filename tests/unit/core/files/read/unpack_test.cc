#include "core/files/read/unpack.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <memory>
#include <string>

#include "core/base/error.h"
#include "tools/gzipped.h"

namespace affskel::core {
namespace {

using tests::gzipped;

std::string zstd(const std::string& text) {
  std::string bytes(ZSTD_compressBound(text.size()), '\0');
  bytes.resize(ZSTD_compress(bytes.data(), bytes.size(), text.data(), text.size(), 3));
  return bytes;
}

std::string numbers() {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += std::to_string(i * 7919 % 100003) + (i % 3 == 2 ? "\n" : " ");
  return text;
}

CoreError::Code refusal(const std::string& bytes) {
  try {
    unpack(bytes);
  } catch (const CoreError& error) {
    return error.code();
  }
  return CoreError::Code::kInternal;
}

TEST(Unpack, GivesWhatWasPacked) {
  for (const std::string& text : {numbers(), std::string("OFF\n"), std::string()}) {
    EXPECT_EQ(compression_of(gzipped(text)), "gzip");
    EXPECT_EQ(compression_of(zstd(text)), "zstd");
    EXPECT_EQ(unpack(gzipped(text)), text);
    EXPECT_EQ(unpack(zstd(text)), text);
    // As `cat` puts them together, and as tapes fill them up.
    EXPECT_EQ(unpack(gzipped(text) + gzipped("more") + std::string(512, '\0')), text + "more");
    EXPECT_EQ(unpack(zstd(text) + zstd("more")), text + "more");
  }
  EXPECT_EQ(compression_of("OFF\n"), "");
  EXPECT_EQ(unpacked_name("a/body.off.gz"), "a/body.off");
  EXPECT_EQ(unpacked_name("body.PLY.ZST"), "body.PLY");
  EXPECT_EQ(unpacked_name("body.off"), "body.off");
}

TEST(Unpack, WhatIsDamagedOrCutOffIsRefused) {
  for (const std::string& bytes : {gzipped(numbers().substr(0, 3000)), zstd(numbers().substr(0, 3000))}) {
    for (std::size_t size = 4; size < bytes.size(); ++size)
      EXPECT_EQ(refusal(bytes.substr(0, size)), CoreError::Code::kBadInput) << size;
  }
  // Where what comes out fills a piece just when the bytes end.
  const std::string even = gzipped(std::string(300000, 'x'));
  for (std::size_t size = 20; size < even.size(); ++size)
    EXPECT_EQ(refusal(even.substr(0, size)), CoreError::Code::kBadInput) << size;
  std::string changed = gzipped(numbers());
  changed[changed.size() / 2] = static_cast<char>(changed[changed.size() / 2] ^ 16);
  EXPECT_EQ(refusal(changed), CoreError::Code::kBadInput) << "its checksum differs";
}

TEST(Unpack, ABombIsRefusedBeforeItBursts) {
  const std::string zeros(std::size_t{1} << 26, '\0');
  EXPECT_EQ(refusal(gzipped(zeros)), CoreError::Code::kLimit);
  EXPECT_EQ(refusal(zstd(zeros)), CoreError::Code::kLimit);
  // A header that claims a window of 2 GiB.
  EXPECT_EQ(refusal(std::string("\x28\xb5\x2f\xfd\x00\xa8\x01\x00\x00", 9)), CoreError::Code::kBadInput);
}

TEST(Unpack, AWindowThatIsTooLargeIsNoDamage) {
  const std::string text = numbers();
  const auto context = std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)>(ZSTD_createCCtx(), ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_windowLog, 27);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_contentSizeFlag, 0);
  // In pieces, for a text that is known to be shorter gets a smaller window.
  std::string bytes(ZSTD_compressBound(text.size()), '\0');
  ZSTD_outBuffer out{bytes.data(), bytes.size(), 0};
  ZSTD_inBuffer in{text.data(), text.size(), 0};
  ZSTD_compressStream2(context.get(), &out, &in, ZSTD_e_continue);
  ASSERT_EQ(ZSTD_compressStream2(context.get(), &out, &in, ZSTD_e_end), 0U);
  bytes.resize(out.pos);
  try {
    unpack(bytes);
    ADD_FAILURE();
  } catch (const CoreError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("more than 32 MiB"), std::string::npos) << message;
    EXPECT_NE(message.find("without --long"), std::string::npos) << message;
    EXPECT_EQ(message.find("damaged"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace affskel::core
