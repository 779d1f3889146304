#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"

namespace affskel::core {

struct PerturbOptions {
  double sigma = 0;        ///< standard deviation of every coordinate's shift, mesh units; >= 0
  std::uint64_t seed = 1;  ///< same seed, same noise, on every machine
};

/// The mesh with Gaussian noise: every place that is a vertex moves by sigma N(0, 1) in x, y and z,
/// independently.  Vertices at the same place move together, so that a closed surface stays closed; places
/// draw their numbers in the order of their first vertex.  Marsaglia's polar method on SplitMix64, the
/// logarithm from + - * / alone.
/// @throws CoreError kBadInput when sigma is negative or not finite, or a coordinate leaves the range of a
///   double.
Mesh perturb(const Mesh& mesh, const PerturbOptions& options);

}  // namespace affskel::core
