#pragma once

#include "client/commands/shared/context.h"
#include "client/view/page.h"

namespace affskel::client {

/// All that the interactive page of a finished job holds; see view_page.  Warns when there is no skeleton.
/// @param params name an operator, see skeleton_params.
/// @throws ClientError kUsage when this version does not know the operator.
ViewInput fetch_view(Context& context, const v1::Job& job, const v1::SkeletonParams& params);

}  // namespace affskel::client
