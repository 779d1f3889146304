#pragma once

#include <string>

#include "affskel/v1/worker_service.pb.h"
#include "core/base/execution_context.h"
#include "job/prepared_job.h"

namespace affskel::worker {

/// The field of the positions of a VERIFY lease alone, in the server's form (ARTIFACT_KIND_FIELD): computed
/// without a look at the stored one, or at what this worker holds of it.
/// @throws core::CoreError kCancelled when the context asks to stop.
std::string sample_field(const v1::Lease& lease, const PreparedJob& job, core::ExecutionContext& context,
                         unsigned threads);

}  // namespace affskel::worker
