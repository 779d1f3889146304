#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/execution_context.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// The differential operators that find shocks as large |H|, H = div n.
enum class ShockOperator { kIntermediate, kCentral, kZuckerHummel, kSobel, kFlux };

/// The operator of that name; nothing when there is none.
std::optional<ShockOperator> shock_operator_named(std::string_view name);

/// The operator's name on the command line and in files.
const char* name_of(ShockOperator shock_operator);

/// The operator's default threshold for |H|; see its header for unit and origin.
/// @param spacing of the lattice, mesh units, > 0; only the plain differences depend on it.
double default_threshold(ShockOperator shock_operator, double spacing);

/// The next higher threshold on the ladder.  The published ladder for Zucker-Hummel is 9, 7, 6 (Zografos
/// 2003, section 6.2.2); its upper step, the factor 9/7, is used for every operator.
double next_threshold(double threshold);

/// H at every sample point by the given operator.
/// @param directions unit normals in the lattice's frame (see frame_directions).
/// @param context asked at every layer of the lattice whether to stop; may be null.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<double> divergence(ShockOperator shock_operator, const Lattice& lattice,
                               const DirectionSet& directions, const OptimalDirections& optimal,
                               ExecutionContext* context = nullptr);

}  // namespace affskel::core
