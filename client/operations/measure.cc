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
  measures.notices = skeleton_notices(measures.solid.curve(), measures.job);
  return measures;
}

}  // namespace affskel::client
