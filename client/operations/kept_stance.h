#pragma once

#include "client/base/stance.h"
#include "client/connection/session.h"

namespace affskel::client {

/// The stance of a job's solid; one that a user chose is kept with the job from now on, or no longer.
core::Stance keep_stance(Session& session, const v1::Job& job, const StanceChoice& choice,
                         const core::Mesh& mesh);

}  // namespace affskel::client
