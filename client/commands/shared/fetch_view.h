#pragma once

#include <optional>
#include <vector>

#include "client/base/up_axis.h"
#include "client/commands/shared/context.h"
#include "client/view/page.h"

namespace affskel::client {

/// What a page is to show side by side: a job, and which skeleton of it.
struct ViewSubject {
  v1::Job job;                ///< finished
  v1::SkeletonParams params;  ///< name an operator, see skeleton_params
};

struct ViewOptions {
  std::optional<UpAxis> up;  ///< absent: that of the first body, see up_axis
  double level = 0;          ///< of the eroded solid that is shown at first, a share of v0; 0 = none is
};

/// All that the interactive page of finished jobs holds; see view_page.  Warns when there is no skeleton.
/// @param subjects one or two.
/// @throws ClientError kUsage when this version does not know the operator.
ViewInput fetch_view(Context& context, const std::vector<ViewSubject>& subjects,
                     const ViewOptions& options = {});

/// The levels of eroded solids that a page carries, shares of v0, ascending: of equal distances in the cube
/// root of E, rounded to two digits, and `wanted` unless it is 0.  Fewer on fine lattices, whose surfaces are
/// large.
/// @param highest E that there is, a share of v0. @param points of the finest lattice.
std::vector<double> view_levels(double highest, double wanted, std::uint64_t points);

}  // namespace affskel::client
