#include "client/operations/measure.h"

#include <algorithm>
#include <tuple>

#include "client/artifacts/surface.h"
#include "client/files/write/curve_graph.h"
#include "client/operations/artifact_calls.h"
#include "client/operations/job_notices.h"

namespace affskel::client {
namespace {

double area_of(const core::Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * core::norm(core::cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  return sum;
}

std::string kind_of(const CurveGraph& graph, const CurveBranch& branch) {
  if (branch.from == branch.to) return "loop";
  const int free = (graph.degree[branch.from] == 1) + (graph.degree[branch.to] == 1);
  return free == 2 ? "line" : free == 1 ? "limb" : "link";
}

// From where it hangs on to its free end, where there is one.
MeasuredPart part_of(const ShapeFile& shape, const CurveGraph& graph, const CurveBranch& branch,
                     double volume) {
  const auto at = [&](std::uint32_t node) { return shape.mesh().points[graph.nodes[node]]; };
  const bool turned = graph.degree[branch.from] == 1 && graph.degree[branch.to] != 1;
  return {.kind = kind_of(graph, branch),
          .from = at(turned ? branch.to : branch.from),
          .to = at(turned ? branch.from : branch.to),
          .length = branch.length,
          .straight_length = branch.straight_length,
          .volume = branch.share * volume,
          .volume_share = branch.share,
          .mean_radius = branch.mean_radius,
          .least_radius = branch.least_radius,
          .greatest_radius = branch.greatest_radius};
}

}  // namespace

Measures measure(Session& session, const std::string& job, double threshold) {
  v1::FetchArtifactRequest asked = request_for(job, v1::ARTIFACT_KIND_SURFACE);
  v1::SkeletonParams& params = *asked.mutable_surface()->mutable_skeleton();
  params.set_operator_(v1::OPERATOR_CURVE);
  params.set_threshold(threshold);
  v1::ArtifactHeader header;
  const FetchedSurface curve = parse_surface(fetch_patiently(session, asked, header, "curve skeleton"));
  Measures measures;
  measures.job = header.job();
  measures.volume = header.job().prepared().volume();
  measures.surface_area = area_of(fetch_mesh(session, header.job().id()));
  measures.curve = curve.quality;
  const CurveGraph graph = curve_graph(curve.shape);
  for (const CurveBranch& branch : graph.branches) {
    measures.curve_length += branch.length;
    measures.parts.push_back(part_of(curve.shape, graph, branch, measures.volume));
  }
  const auto order = [](const MeasuredPart& part) {
    return std::tuple(-part.volume, part.to.x, part.to.y, part.to.z);
  };
  std::sort(measures.parts.begin(), measures.parts.end(),
            [&](const MeasuredPart& a, const MeasuredPart& b) { return order(a) < order(b); });
  measures.notices = skeleton_notices(graph.branches.size(), curve.quality, header.job());
  return measures;
}

}  // namespace affskel::client
