#include "client/operations/measure.h"

#include "client/operations/artifact_calls.h"
#include "client/operations/job_notices.h"

namespace affskel::client {

Measures measure(Session& session, const std::string& job, double threshold) {
  Measures measures;
  v1::ArtifactHeader header;
  measures.solid = fetch_solid_parts(session, job, threshold, header);
  measures.job = header.job();
  for (const v1::SolidPart& part : measures.solid.parts()) measures.curve_length += part.length();
  const v1::TriangleMesh& curve = measures.solid.curve();
  measures.notices =
      skeleton_notices(static_cast<std::uint64_t>(curve.segments_size() / 2), curve.quality(), measures.job);
  return measures;
}

}  // namespace affskel::client
