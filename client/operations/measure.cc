#include "client/operations/measure.h"

#include "client/operations/artifact_calls.h"
#include "client/operations/job_notices.h"

namespace affskel::client {

Measures measure(Session& session, const std::string& job, double threshold) {
  Measures measures;
  v1::ArtifactHeader header;
  measures.solid = fetch_solid_parts(session, job, threshold, header);
  measures.job = header.job();
  for (const auto* branches : {&measures.solid.parts(), &measures.solid.links()})
    for (const v1::SolidPart& branch : *branches) measures.curve_length += branch.length();
  const v1::TriangleMesh& curve = measures.solid.curve();
  measures.notices =
      skeleton_notices(static_cast<std::uint64_t>(curve.xyz_size() / 3), curve.quality(), measures.job);
  return measures;
}

}  // namespace affskel::client
