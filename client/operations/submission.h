#pragma once

#include <cstdint>
#include <string>

#include "client/connection/environment.h"
#include "client/connection/session.h"
#include "client/files/read/input_file.h"
#include "client/operations/repair.h"
#include "client/operations/skeleton_choice.h"

namespace affskel::client {

/// What a submission may ask for; every face refuses the rest with these bounds.
inline constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 31;
inline constexpr unsigned kMaxPriority = 9;

/// What is asked of a mesh that is submitted.
struct Submission {
  double spacing = 0;  ///< mesh units; 0 = by points
  std::uint64_t points = 100000;
  std::string directions = "triangles";
  std::string frame = "axis";
  std::string minimum = "set";
  SkeletonChoice skeleton{"ridge"};
  std::string name;  ///< empty = the file's stem
  unsigned priority = 5;
  std::string request_id;
  bool repair = true;
};

/// Of the solid's box parallel to the axes, mesh units.
double longest_side(const core::Solid& solid);

/// A lattice of a few points has no skeleton: mostly the spacing is meant in another unit than the mesh has.
/// @param spacing mesh units; 0 = by a number of points, which is never wrong.
/// @param path that the error names.
/// @throws ClientError kBadInput with the size of the mesh, the unit that it looks like, and a spacing that would do.
void check_spacing(const core::Solid& solid, double spacing, const std::string& path);

/// Checks what a worker would refuse of lattice and directions, before anything is sent.
/// @throws ClientError kBadInput or kLimit.
void check_submission(const core::Solid& solid, const InputFile& input, const Submission& submission);

/// What would take much less time, where a mesh has so many triangles, as scans and wraps have, that their normals are far more
/// directions than are needed.
Notices direction_notices(const core::Solid& solid, const Submission& asked);

struct Submitted {
  v1::Job job;
  bool existed = false;  ///< an earlier job answers this submission
};

/// Submits the mesh.
/// @param source what it was before its repair, which is kept with the job; null where it was not repaired.
/// @param environment names the user to a server that does not know its callers.
/// @throws ClientError kUsage when the protocol has no room for a text; kLimit when the server takes no file
/// as large; as Session::submit.
Submitted submit(Session& session, const Environment& environment, const InputFile& input,
                 const MeshSource* source, const Submission& submission);

/// How the work on a submission was done before, wholly or but for the skeleton, if it was.
Notices reuse_notices(const Submitted& submitted);

}  // namespace affskel::client
