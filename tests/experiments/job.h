#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/erosion/directions.h"
#include "core/erosion/field.h"
#include "core/lattice/lattice.h"
#include "core/shocks/shock_operator.h"
#include "core/solid/betti_numbers.h"
#include "core/solid/solid.h"
#include "core/solid/solid_frame.h"

namespace affskel::experiments {

struct JobOptions {
  double spacing = 0;  ///< dT, mesh units
  std::string directions = "triangles";
  core::FrameKind frame = core::FrameKind::kAxis;
  unsigned threads = 1;
};

/// A finished erosion field, all of it in mesh units.
struct Job {
  core::Mesh mesh;
  core::Solid solid;
  core::Lattice lattice;
  core::DirectionSet directions;
  bool over_set = true;  ///< whether the values are the least of these directions, or of all
  std::vector<std::array<std::uint32_t, 2>> saddles;  ///< of all: per sample point core::LeastChord::saddles
  std::vector<core::FieldValue> values;               ///< per sample point
  double seconds = 0;                                 ///< from the mesh to the field, wall time

  /// Largest E in the field as a share of v0.
  double highest_share() const;
};

/// Prepares and erodes in this process, as `affskel-worker compute` does.
/// @throws core::CoreError
Job compute(const core::Mesh& mesh, const JobOptions& options);

/// Some of the sample points, in lattice order.
struct Cloud {
  std::vector<std::uint32_t> rank;
  std::vector<core::Vec3> place;  ///< mesh units
  std::vector<double> erosion;    ///< E, mesh units cubed

  std::size_t size() const { return rank.size(); }
};

/// The points with |H| > threshold.
Cloud thresholded(const Job& job, std::span<const double> divergence, double threshold);

/// H by the given operator.
std::vector<double> divergence_of(const Job& job, core::ShockOperator shock_operator);

/// The skeleton with the Zucker-Hummel operator and the published threshold.
Cloud zucker_hummel_skeleton(const Job& job);

/// All sample points.
Cloud all_points(const Job& job);

/// The cloud's voxels as one body: components (26 neighbours), tunnels, voids.
core::BettiNumbers topology(const Job& job, const Cloud& cloud);

/// 26-connected pieces of the cloud's voxels, by the number of their points, largest first.
std::vector<std::size_t> piece_sizes(const Job& job, const Cloud& cloud);

}  // namespace affskel::experiments
