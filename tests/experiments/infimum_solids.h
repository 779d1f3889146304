#pragma once

#include <string>
#include <vector>

#include "core/mesh/mesh.h"
#include "experiments.h"

namespace affskel::experiments {

struct InfimumSolid {
  std::string name;
  core::Mesh mesh;
  double spacing = 0;
};

/// Bodies and solids with narrow minima, of which the infimum is tried; two when the setting is quick.
std::vector<InfimumSolid> infimum_solids(const Setting& setting);

}  // namespace affskel::experiments
