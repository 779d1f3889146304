#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/lattice/lattice.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid_frame.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr std::array kFrames = {FrameKind::kAxis, FrameKind::kPca, FrameKind::kObb, FrameKind::kAffine};

// What is said of a limit, "" of none.
template <class Call>
std::string limit_of(const Call& call) {
  try {
    call();
  } catch (const CoreError& error) {
    return error.code() == CoreError::Code::kLimit ? error.what() : "";
  }
  return "";
}

std::string checked(const Solid& solid, FrameKind kind, const LatticeOptions& options) {
  return limit_of([&] { check_lattice(solid, kind, options); });
}

std::string made(const Solid& solid, const Matrix3& frame, LatticeOptions options) {
  options.frame = frame;
  return limit_of([&] { make_lattice(solid, options); });
}

double named_spacing(const std::string& message) {
  const std::string before = "take a spacing of ";
  const std::size_t at = message.find(before);
  return at == std::string::npos ? std::nan("") : std::stod(message.substr(at + before.size()));
}

std::vector<Solid> solids() {
  std::vector<Solid> list;
  // Bounded by points, by lines, by either.
  list.push_back(make_solid(make_box(3, 2, 1)));
  list.push_back(make_solid(shaken(make_box(300, 200, 0.01), 0, 1)));
  list.push_back(make_solid(shaken(make_torus(6000, 400, 256), 0, 2)));
  return list;
}

TEST(CheckLattice, RefusesWhatMakeLatticeRefusesAndNothingElse) {
  for (const Solid& solid : solids()) {
    for (const FrameKind kind : kFrames) {
      const Matrix3 frame = solid_frame(solid, kind);
      LatticeOptions options;
      options.max_points = 3000;
      options.max_lines = 9000;
      options.spacing = 0.03 * std::cbrt(solid.volume);
      int refused = 0, accepted = 0;
      for (; accepted < 5; options.spacing *= 1.3) {
        const std::string message = checked(solid, kind, options);
        EXPECT_EQ(message, made(solid, frame, options)) << options.spacing;
        (message.empty() ? accepted : refused) += 1;
        EXPECT_TRUE(message.empty() || accepted == 0);
      }
      EXPECT_GT(refused, 3);
    }
  }
}

TEST(CheckLattice, NamesTheLeastSpacing) {
  for (const Solid& solid : solids()) {
    for (const FrameKind kind : kFrames) {
      for (const std::uint64_t max_points : {std::uint64_t{100}, std::uint64_t{1} << 31}) {
        LatticeOptions options;
        options.max_points = max_points;
        options.spacing = 1e-9 * solid.scale();
        const double least = named_spacing(checked(solid, kind, options));
        options.spacing = least;
        EXPECT_EQ(checked(solid, kind, options), "");
        options.spacing = 0.998 * least;
        EXPECT_EQ(named_spacing(checked(solid, kind, options)), least);
      }
    }
  }
}

TEST(CheckLattice, TellsWhatTheSpacingWouldGive) {
  const Solid solid = make_solid(make_box(300, 200, 100));
  LatticeOptions options;
  options.spacing = 0.01;
  EXPECT_EQ(
      checked(solid, FrameKind::kAxis, options),
      "spacing 0.01 would give about 6e+12 sample points on about 1.1e+09 lattice lines; at most 2.15e+09 "
      "points on 4e+08 lines are supported: take a spacing of 0.1409 or more");
  options.spacing = 1e-300;
  EXPECT_NE(checked(solid, FrameKind::kAxis, options).find("more than 1e+308 sample points"),
            std::string::npos);
}

TEST(CheckLattice, WorksAtAnyScale) {
  for (const double scale : {1e-90, 1.0, 1e90}) {
    const Solid solid = make_solid(make_box(3 * scale, 2 * scale, scale));
    LatticeOptions options;
    options.spacing = 1e-5 * scale;
    EXPECT_NEAR(named_spacing(checked(solid, FrameKind::kObb, options)) / scale, 1.409e-3, 1e-6);
    options.spacing = 0.1 * scale;
    EXPECT_EQ(checked(solid, FrameKind::kObb, options), "");
  }
}

TEST(CheckLattice, AsManyPointsAsAllowedMayBeAimedAt) {
  for (const std::uint64_t most : {100u, 331u, 1000u, 2048u}) {
    for (const double side : {1.0, 0.7, 1.3, 18.1}) {
      const Solid solid = make_solid(make_box(side, side / 3, 2 * side));
      LatticeOptions options;
      options.max_points = options.target_points = most;
      EXPECT_EQ(checked(solid, FrameKind::kAxis, options), "");
      EXPECT_EQ(made(solid, kIdentity3, options), "");
      options.target_points = most + 1;
      EXPECT_NE(checked(solid, FrameKind::kAxis, options), "");
      EXPECT_EQ(checked(solid, FrameKind::kAxis, options), made(solid, kIdentity3, options));
    }
  }
  // The largest that the protocol allows.
  LatticeOptions options;
  options.target_points = std::uint64_t{1} << 31;
  for (const Solid& solid : solids()) EXPECT_EQ(checked(solid, FrameKind::kAxis, options), "");
}

TEST(CheckLattice, LeavesThinSolidsToTheSearchForTheirPoints) {
  // Lines enough for a layer of the plate, but not for the cube root of its volume per point.
  const Solid plate = make_solid(make_box(100, 100, 1e-4));
  LatticeOptions options;
  options.target_points = 1000;
  options.max_lines = 20000;
  EXPECT_EQ(checked(plate, FrameKind::kAxis, options), "");
  EXPECT_NEAR(make_lattice(plate, options).points, 1000, 100);
}

TEST(CheckLattice, RefusesSpacingsThatAreNone) {
  LatticeOptions options;
  for (const double spacing : {-1.0, std::nan(""), HUGE_VAL}) {
    options.spacing = spacing;
    EXPECT_THROW(check_lattice(make_solid(make_box(1, 1, 1)), FrameKind::kAxis, options), CoreError);
  }
}

}  // namespace
}  // namespace affskel::core
