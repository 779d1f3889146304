#pragma once

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/files/format.h"
#include "client/files/write/atomic_file.h"

namespace affskel::client {

/// Parse a SKELETON and an ERODED_POINTS artefact (whose points have no H).
/// @throws ClientError kInternal when its arrays differ in length.
v1::SkeletonPoints parse_skeleton(const std::string& bytes);
v1::SkeletonPoints parse_eroded_points(const std::string& bytes);

/// Writes skeleton points in one of skeleton_formats(): .csv `x,y,z,E,nx,ny,nz,direction,H`; .ply binary with
/// the same as properties; .vtp with them as arrays (see write_vtp); .off and .xyz coordinates alone.  Points
/// of an eroded solid come without H.
/// @param comments lines for formats that have comments (PLY, VTP), without line breaks.
void write_skeleton(FileFormat format, const v1::SkeletonPoints& skeleton,
                    const std::vector<std::string>& comments, AtomicFile& file);

}  // namespace affskel::client
