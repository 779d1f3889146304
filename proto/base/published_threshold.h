#pragma once

namespace affskel::base {

/// |H| above which the operator of Zucker and Hummel keeps a point, without unit and whatever the spacing:
/// Zografos (2003, section 6.2.2) found by trial that 7 gives the best skeletons on all his inputs.  At a
/// sheet parallel to two axes it stands for a jump of the normal component across the sheet of J = 7 / (1 + 2
/// sqrt(2) + 4 sqrt(3)/3) = 1.140.
inline constexpr double kZuckerHummelThreshold = 7;

}  // namespace affskel::base
