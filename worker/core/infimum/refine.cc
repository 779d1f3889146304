#include "core/infimum/refine.h"

#include "base/refine_rounds.h"
#include "core/infimum/refinement.h"

namespace affskel::core {

std::vector<LeastChord> refine(const PieceInput& input, const Lattice& lattice,
                               const DirectionSet& directions, const ErosionField& seeds, unsigned threads,
                               ExecutionContext& context) {
  Refinement refinement(input, lattice, threads);
  const PointRange all{0, lattice.points};
  const auto seed = [&](std::uint32_t point) { return seeds.value(point); };
  std::vector<RefinedPoint> found = refinement.descend(directions, seed, all, context);
  for (int round = 0; !found.empty(); ++round) {
    for (const RefinedPoint& point : found) refinement.set(point, round);
    if (round == base::kMostRefineRounds) break;
    found = refinement.improve(round + 1, all, context);
  }
  return refinement.take();
}

}  // namespace affskel::core
