#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace affskel::fuzz {

/// What the code under test did is wrong.  Thrown through everything: a fuzzer takes it for a crash.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Code that takes bytes from outside.
struct Target {
  const char* name;
  /// Inputs to begin from, made by the project's own writers and generators.
  std::vector<std::string> (*seeds)();
  /// Gives it the input, and checks what must hold of whatever comes out.  Errors that the code documents are
  /// answers, too.
  /// @throws Finding, or whatever the code should not throw.
  void (*run)(std::string_view input);
  std::size_t short_runs;  ///< executions of the short run among all tests: about a second
};

/// All of them, in the order of their files.
std::span<const Target> targets();

/// @throws std::invalid_argument for an unknown name, with those that there are.
const Target& target_named(std::string_view name);

extern const Target kMeshFiles, kRepair, kBlockSolids, kMessages, kArtefacts, kFrames, kStoreCalls, kDatabase,
    kCommandLine;

}  // namespace affskel::fuzz
