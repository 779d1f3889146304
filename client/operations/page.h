#pragma once

#include <string>
#include <vector>

#include "client/base/notice.h"
#include "client/base/stance.h"
#include "client/connection/session.h"
#include "client/view/page.h"

namespace affskel::client {

/// What a page is to show side by side: a job, and which skeleton of it.
struct ViewSubject {
  v1::Job job;                ///< finished
  v1::SkeletonParams params;  ///< name an operator, see skeleton_params
};

struct ViewOptions {
  StanceChoice stance;  ///< what is chosen is kept with the job
  double level = 0;     ///< of the eroded solid that is shown at first, a share of v0; 0 = none is
};

struct Page {
  std::string html;
  ViewInput input;  ///< what it shows
  Notices notices;  ///< that there is no skeleton, or no eroded solid at the level
};

/// The interactive page of finished jobs; see view_page.
/// @param subjects one or two.
/// @throws ClientError kUsage when this version does not know the operator.
Page make_page(Session& session, const std::vector<ViewSubject>& subjects, const ViewOptions& options = {});

/// The levels of eroded solids that a page carries, shares of v0, ascending: of equal distances in the cube
/// root of E, rounded to two digits, and `wanted` unless it is 0.  Fewer on fine lattices, whose surfaces are
/// large.
/// @param highest E that there is, a share of v0. @param points of the finest lattice.
std::vector<double> view_levels(double highest, double wanted, std::uint64_t points);

}  // namespace affskel::client
