#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/none.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// A cube that a realm begins in.
struct RealmSeed {
  std::uint32_t cube = 0;
  float radius = 0;  ///< steps, >= 0: of a ball about it, from which ways count
};

/// Parts the cubes among seeds: each belongs to the seed whose ball it is nearest to, by ways over cubes (26 neighbours,
/// see DualComplex::for_each_step), so that a thick limb keeps what a thin one beside it comes nearer to.  Every realm
/// hangs together (Dial 1969).
/// @return per cube: the number of its seed; kNone where no seed can be reached.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<std::uint32_t> realms(const DualComplex& complex, std::span<const RealmSeed> seeds,
                                  ExecutionContext* context = nullptr);

}  // namespace affskel::core
