#pragma once

#include <string>
#include <vector>

namespace affskel::core {

/// One setting of a job, or of what is derived from it: "threshold", "3.1"; named as in the protocol.
struct Setting {
  std::string name, value;
};

/// Why something is empty, and what to try.
struct Advice {
  std::string text;               ///< sentences that name no program's options; empty: nothing to say
  std::vector<Setting> settings;  ///< that would help, the most promising first
};

}  // namespace affskel::core
