#include "core/infimum/refine.h"

#include "core/infimum/refinement.h"

namespace affskel::core {

std::vector<LeastChord> refine(const PieceInput& input, const Lattice& lattice,
                               const DirectionSet& directions, const ErosionField& seeds,
                               const RefineOptions& options, ExecutionContext& context, RefineCost* cost) {
  Refinement refinement(input, lattice, options.threads);
  const PointRange all{0, lattice.points};
  const auto seed = [&](std::uint32_t point) { return seeds.value(point); };
  std::vector<RefinedPoint> found = refinement.descend(directions, seed, all, context);
  int round = 0;
  for (;; ++round) {
    for (const RefinedPoint& point : found) refinement.set(point, round);
    if (round == options.most_rounds) break;
    found = refinement.improve(round + 1, all, context);
    if (found.empty()) break;
  }
  if (cost != nullptr) *cost = {round, refinement.evaluations()};
  return refinement.take();
}

}  // namespace affskel::core
