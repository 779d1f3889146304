#pragma once

#include <cstdint>
#include <string>

#include "affskel/v1/types.pb.h"
#include "client/base/notice.h"
#include "client/connection/session.h"

namespace affskel::client {

/// That a skeleton has no points, with the likely reason and what to try; the advice that its quality holds.
/// @param items points that it has.
Notices skeleton_notices(std::uint64_t items, const v1::SkeletonQuality& quality, const v1::Job& job);

/// Of a sheet or lines; a single vertex is a skeleton, too.
Notices skeleton_notices(const v1::TriangleMesh& skeleton, const v1::Job& job);

/// That the surface of an eroded solid is empty, and why.
Notices eroded_notices(const v1::TriangleMesh& eroded);

/// What to know of a done job: of its skeleton, its mesh and its lattice.
Notices end_notices(const v1::Job& job);

/// "failed: CODE: message", "was cancelled at 5 of 12 directions" or "is running: 5 of 12 directions are
/// done", for a job that does not have what was asked for.
std::string unfinished_text(const v1::Job& job);

/// A job to show, which must be done.  @throws ClientError kNotFound saying how far it is.
v1::Job finished_job(Session& session, const std::string& name);

}  // namespace affskel::client
