#pragma once

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

// The words for the protocol's enumerations (see wire::word), as the command line takes and shows them: what
// the protocol gains, the command line knows.

/// "queued", "running", "done", "failed", "cancelled"; "unknown" for anything else.
std::string state_word(v1::JobState state);
/// "prepare", "erode", "refine", "derive", "complete"; "unknown" for anything else.
std::string stage_word(v1::JobStage stage);
/// "axis", "pca", "obb" or "affine"; "axis" when none is specified, "unknown" for anything else.
std::string frame_word(v1::Frame frame);
/// "set" or "infimum"; "set" when none is specified, "unknown" for anything else.
std::string minimum_word(v1::Minimum minimum);
/// "zucker-hummel", "intermediate", ...; the default one when none is specified, "unknown" for anything else.
std::string operator_word(v1::Operator which);

/// As what a step of a repair is told: "warning", else "repaired", also where its client does not say.
std::string severity_word(const v1::RepairStep& step);

/// "limb", "line", "link", "loop" or "point"; "unknown" for anything else.
std::string part_kind_word(v1::PartKind kind);

/// All words of a kind, in the protocol's order.
std::vector<std::string> state_words();
std::vector<std::string> frame_words();
std::vector<std::string> minimum_words();
std::vector<std::string> operator_words();

/// The value that a word stands for.  @throws ClientError kUsage naming the possible words.
v1::JobState state_named(const std::string& word);
v1::Frame frame_named(const std::string& word);
v1::Minimum minimum_named(const std::string& word);
v1::Operator operator_named(const std::string& word);

}  // namespace affskel::client
