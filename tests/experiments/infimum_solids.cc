#include "infimum_solids.h"

#include "core/shapes/shapes.h"
#include "core/test_solids.h"
#include "reference/hard_solids.h"

namespace affskel::experiments {

std::vector<InfimumSolid> infimum_solids(const Setting& setting) {
  std::vector<InfimumSolid> solids = {{"body of 292", setting.body(292), setting.spacing()},
                                      {"torus of 256", core::make_torus(3, 1, 256), 0.2}};
  if (setting.quick) return solids;
  solids.push_back({"body of 500", setting.body(500), setting.spacing()});
  solids.push_back({"body of 1000", setting.body(1000), setting.spacing()});
  solids.push_back({"cup", core::shaken(core::cup(24), 0, 2), 0.1});
  solids.push_back({"comb", core::shaken(core::comb(6), 0, 3), 0.2});
  solids.push_back({"helix", reference::make_helix(3, 0.7, 2, 3, 24, 8), 0.2});
  return solids;
}

}  // namespace affskel::experiments
