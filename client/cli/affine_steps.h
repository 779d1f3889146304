#pragma once

#include <CLI/App.hpp>
#include <array>
#include <string>
#include <vector>

#include "core/base/affine_map.h"

namespace affskel::client {

/// One option of `transform`, as it was written.
struct AffineStep {
  std::string option;  ///< "--matrix", "--scale", "--rotate", "--translate" or "--shear"
  std::string value;
};

/// The options of `transform` for the steps of a map, each of which may be given several times.
class AffineStepOptions {
 public:
  AffineStepOptions() = default;
  AffineStepOptions(const AffineStepOptions&) = delete;
  AffineStepOptions& operator=(const AffineStepOptions&) = delete;

  /// Adds them to a command, once; this must outlive the command's parse.
  void add_to(CLI::App* command);

  /// What was given, in the order of the command line, whatever the options.
  std::vector<AffineStep> in_order() const;

 private:
  const CLI::App* command_ = nullptr;
  std::array<std::vector<std::string>, 5> values_;  // CLI11 wants a place for those of each option
};

/// The map of one step:
///   --matrix a11,a12,a13,a21,...   9 numbers row by row, or 12 with the shift as the fourth of every row;
///   --scale s or s,s,s;  --translate x,y,z;
///   --rotate x|y|z:DEGREES         counter-clockwise seen from the tip of the axis;
///   --shear y+=z, y+=0.5z, y+=0.5*z or yz:0.5
/// @throws ClientError kUsage.
core::AffineMap affine_step(const AffineStep& step);

/// All steps, one after the other.
/// @throws ClientError kUsage for a step that does not parse, and when the whole is singular.
core::AffineMap affine_map_of(const std::vector<AffineStep>& steps);

}  // namespace affskel::client
