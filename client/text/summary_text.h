#pragma once

#include <cstdint>
#include <string>

#include "affskel/v1/types.pb.h"
#include "client/base/notice.h"

namespace affskel::client {

/// Below so many sample points a solid is only a few of them thick.
inline constexpr std::uint64_t kCoarseLattice = 2000;

/// What to call files about a job of this name: without what a file's name cannot hold, or would begin an
/// option.
std::string file_stem(const std::string& name);

/// What to know of a done job whose skeleton has points: warnings of the mesh's repair, of the mesh and of its
/// directions, a coarse lattice, a skeleton in more pieces than the solid.
Notices job_warnings(const v1::Job& job);

/// Of these the last two, for a skeleton of that quality.
Notices skeleton_warnings(const v1::PreparedSummary& prepared, const v1::SkeletonQuality& quality);

/// "done in 3.214 s: 99812 points, 500 directions, skeleton of 2013 points in 1 piece".
std::string summary_text(const v1::Job& job);

/// Whether the field was there already when the job was submitted, so that nothing was eroded for it.
bool took_field_over(const v1::Job& job);

}  // namespace affskel::client
