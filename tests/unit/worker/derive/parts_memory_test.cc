#include <gtest/gtest.h>

#include <cstdint>

#include "core/shapes/body.h"
#include "core/text/off_file.h"
#include "derive/derived.h"
#include "sample_job.h"
#include "tools/heap_bytes.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace affskel::worker {
namespace {

constexpr std::uint64_t kBytesPerPoint = 150;

// Beside mesh, lattice and the field's bytes.
TEST(PartsMemory, IsBounded) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(6);
  params.set_directions("sphere:80");
  const PreparedJob prepared(core::write_off(core::make_body({.triangles = 500})), params);
  const std::string field = finished_field(prepared);
  const std::uint64_t before = tests::heap_bytes();
  tests::begin_heap_peak();
  const v1::SolidParts solid = parts_of(prepared, field);
  EXPECT_GT(solid.parts_size(), 3);
  const std::uint64_t points = prepared.lattice().points;
  const std::uint64_t taken = tests::heap_peak() - before;
  EXPECT_GT(taken, 50 * points);  // it is counted
  EXPECT_LE(taken, kBytesPerPoint * points) << points << " points";
}

}  // namespace
}  // namespace affskel::worker
#endif
