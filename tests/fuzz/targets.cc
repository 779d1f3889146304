#include "targets.h"

#include <array>

namespace affskel::fuzz {

std::span<const Target> targets() {
  static const std::array<Target, 9> all = {kMeshFiles, kRepair,     kBlockSolids, kMessages,   kArtefacts,
                                            kFrames,    kStoreCalls, kDatabase,    kCommandLine};
  return all;
}

const Target& target_named(std::string_view name) {
  std::string names;
  for (const Target& target : targets()) {
    if (target.name == name) return target;
    names += (names.empty() ? "" : ", ") + std::string(target.name);
  }
  throw std::invalid_argument("no target is called '" + std::string(name) + "'; there are " + names);
}

}  // namespace affskel::fuzz
