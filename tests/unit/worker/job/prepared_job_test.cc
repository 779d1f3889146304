#include "job/prepared_job.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/stopping_context.h"
#include "sample_job.h"
#include "wire/memory_sizes.h"

namespace affskel::worker {
namespace {

TEST(PreparedJob, DescribesWhatItPrepared) {
  const PreparedJob job(sample_mesh(), sample_params());
  const v1::PreparedSummary summary = job.summary();
  EXPECT_EQ(summary.triangles(), 256U);
  EXPECT_EQ(summary.genus(), 1);
  EXPECT_EQ(summary.directions(), 256U);
  EXPECT_EQ(summary.points(), job.lattice().points);
  EXPECT_EQ(job.directions_message().xyz_size(), 3 * 256);
  const v1::Lattice lattice = job.lattice_message();
  std::uint64_t points = 0, end = 0;
  for (int r = 0; r < lattice.run_start_size(); ++r) {
    EXPECT_GE(lattice.run_start(r), end);
    end = lattice.run_start(r) + lattice.run_length(r);
    points += lattice.run_length(r);
    EXPECT_EQ(lattice.run_start(r) / lattice.dims(2), (end - 1) / lattice.dims(2)) << "a run leaves its line";
  }
  EXPECT_EQ(points, summary.points());
}

TEST(PreparedJob, StopsWhereverItIsAsked) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_target_points(100000);
  core::expect_stops_wherever_it_is_asked(
      10, [&](core::ExecutionContext* context) { const PreparedJob job(sample_mesh(), params, 1, context); });
}

// Its erosion starts from the server's field, 20 bytes a point, which a worker holds beside its own.
TEST(PreparedJob, RefusesWhatDoesNotFitIntoMemory) {
  const auto fits = [](std::uint64_t available, double derive_bytes = 0) {
    try {
      const PreparedJob job(
          sample_mesh(), sample_params(), 1, nullptr, [&] { return available; }, derive_bytes);
      return true;
    } catch (const core::CoreError& error) {
      EXPECT_EQ(error.code(), core::CoreError::Code::kLimit);
      return false;
    }
  };
  const auto of_skeleton = [](v1::Operator which) {
    return static_cast<double>(wire::skeleton_bytes_per_point(which));
  };
  const std::uint64_t points = PreparedJob(sample_mesh(), sample_params()).lattice().points;
  EXPECT_FALSE(fits(45 * points));
  EXPECT_TRUE(fits(70 * points));
  // What is derived in the end takes more than the erosion.
  EXPECT_FALSE(fits(240 * points, of_skeleton(v1::OPERATOR_CHORDS)));
  EXPECT_TRUE(fits(240 * points, of_skeleton(v1::OPERATOR_ZUCKER_HUMMEL)));
  EXPECT_TRUE(fits(480 * points, of_skeleton(v1::OPERATOR_CHORDS)));
}

TEST(PreparedJob, LaysTheLatticeInTheFrameThatIsAskedFor) {
  v1::ErosionParams params = sample_params();
  const v1::PreparedSummary plain = PreparedJob(sample_mesh(), params).summary();
  ASSERT_EQ(plain.frame_size(), 9);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(plain.frame(i), i % 4 == 0 ? 1 : 0);
  params.set_frame(v1::FRAME_AFFINE);
  params.set_directions("triangles+sphere:20");
  const PreparedJob affine(sample_mesh(), params);
  const v1::PreparedSummary summary = affine.summary();
  const v1::Lattice lattice = affine.lattice_message();
  // A torus about z is wide and flat.
  for (int axis = 0; axis < 3; ++axis) {
    const double x = summary.frame(3 * axis), y = summary.frame(3 * axis + 1),
                 z = summary.frame(3 * axis + 2);
    if (std::abs(z) > 0.1) {
      EXPECT_LT(std::abs(z), 0.9);
    } else {
      EXPECT_GT(std::hypot(x, y), 1.1);
    }
  }
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(lattice.axes(i), 500 * summary.frame(i), 1e-9);
  EXPECT_EQ(summary.spacing(), 500);
  // The sphere's directions crowd round the axis that the frame has shortened.
  double along_x = 0, along_z = 0;
  for (std::size_t i = 256; i < affine.directions().size(); ++i) {
    along_x += std::abs(affine.directions()[i].x);
    along_z += std::abs(affine.directions()[i].z);
  }
  EXPECT_GT(along_z, 1.2 * along_x);
  params.set_frame(static_cast<v1::Frame>(99));
  EXPECT_THROW(PreparedJob(sample_mesh(), params), core::CoreError);
}

int count_changes(core::ErosionField& field) {
  int count = 0;
  field.take_changes([&](std::uint32_t, const core::FieldValue&) { ++count; });
  return count;
}

TEST(PreparedJob, StartsFromTheStoredField) {
  PreparedJob job(sample_mesh(), sample_params());
  const std::string stored = finished_field(job);
  core::Erosion& erosion = job.erosion(1, stored);
  EXPECT_EQ(count_changes(erosion.field()), 0);
  // Doing a direction again improves nothing.
  const std::uint32_t direction = 17;
  core::ExecutionContext context;
  erosion.run({&direction, 1}, context);
  EXPECT_EQ(count_changes(erosion.field()), 0);
  EXPECT_THROW(unpack_field(stored.substr(1), job.lattice().points), core::CoreError);
}

}  // namespace
}  // namespace affskel::worker
