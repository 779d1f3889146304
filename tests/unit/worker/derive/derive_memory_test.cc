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

// Per sample point, beside mesh, lattice and the field's bytes.
constexpr std::uint64_t kPartsBytes = 150, kRidgeBytes = 200;

PreparedJob body() {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(6);
  params.set_directions("sphere:80");
  return PreparedJob(core::write_off(core::make_body({.triangles = 500})), params);
}

// What a task takes of it at most.
template <class Task>
void expect_at_most(std::uint64_t bytes, const PreparedJob& prepared, const Task& task) {
  const std::uint64_t before = tests::heap_bytes();
  tests::begin_heap_peak();
  task();
  const std::uint64_t points = prepared.lattice().points;
  const std::uint64_t taken = tests::heap_peak() - before;
  EXPECT_GT(taken, 50 * points);  // it is counted
  EXPECT_LE(taken, bytes * points) << points << " points";
}

TEST(PartsMemory, IsBounded) {
  const PreparedJob prepared = body();
  const std::string field = finished_field(prepared);
  for (const unsigned threads : {1U, 4U})
    expect_at_most(kPartsBytes, prepared,
                   [&] { EXPECT_GT(parts_of(prepared, field, 0, threads).parts_size(), 3); });
}

TEST(RidgeMemory, IsBounded) {
  const PreparedJob prepared = body();
  const std::string field = finished_field(prepared);
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  for (const unsigned threads : {1U, 4U}) {
    expect_at_most(kRidgeBytes, prepared, [&] {
      const Derived derived = derive(lease, prepared, field, nullptr, threads);
      EXPECT_GT(parsed<v1::TriangleMesh>(derived).xyz_size(), 300);
    });
  }
}

}  // namespace
}  // namespace affskel::worker
#endif
