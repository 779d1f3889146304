// The memory that the parts of a solid take, in a process of its own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>

#include "core/shapes/body.h"
#include "core/text/off_file.h"
#include "derive/derived.h"
#include "sample_job.h"
#include "tools/peak_memory.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace affskel::worker {
namespace {

// 143 to 154 are taken, as glibc keeps more or less of what was freed: the length of the command decides.
constexpr std::uint64_t kBytesPerPoint = 160;

// 0 when the parts take no more than so much beside mesh, lattice and the field's bytes.
[[noreturn]] void derive_within_bound() {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(6);
  params.set_directions("sphere:80");
  const PreparedJob prepared(core::write_off(core::make_body({.triangles = 500})), params);
  const std::string field = finished_field(prepared);
  const std::uint64_t before = tests::peak_memory();
  const v1::SolidParts solid = parts_of(prepared, field);
  const std::uint64_t taken = tests::peak_memory() - before;
  const std::uint64_t points = prepared.lattice().points;
  std::fprintf(stderr, "%ju bytes for %ju points: %ju\n", std::uintmax_t{taken}, std::uintmax_t{points},
               std::uintmax_t{taken / points});
  _exit(solid.parts_size() > 3 && taken <= kBytesPerPoint * points ? 0 : 1);
}

TEST(PartsMemoryDeathTest, IsBounded) {
  EXPECT_EXIT(derive_within_bound(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace affskel::worker
#endif
