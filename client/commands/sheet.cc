#include "client/commands/sheet.h"

#include <algorithm>

#include "client/commands/transfer.h"

namespace affskel::client {
namespace {

bool is_sheet(const v1::TriangleMesh& mesh) {
  const int vertices = mesh.xyz_size() / 3;
  const auto in_range = [&](std::uint32_t v) { return v < static_cast<std::uint32_t>(vertices); };
  return mesh.xyz_size() == 3 * vertices && mesh.erosion_size() == vertices &&
         mesh.strength_size() == vertices && mesh.corners_size() % 3 == 0 &&
         std::all_of(mesh.corners().begin(), mesh.corners().end(), in_range);
}

}  // namespace

v1::TriangleMesh fetch_sheet(Context& context, const std::string& job, const v1::SkeletonParams& params) {
  v1::FetchArtifactRequest request = request_for(job, v1::ARTIFACT_KIND_SURFACE);
  *request.mutable_surface()->mutable_skeleton() = params;
  v1::ArtifactHeader header;
  v1::TriangleMesh sheet;
  if (!sheet.ParseFromString(fetch_patiently(context, request, header, "sheet")) || !is_sheet(sheet)) {
    throw ClientError(ExitCode::kInternal, "the server sent a damaged sheet");
  }
  return sheet;
}

}  // namespace affskel::client
