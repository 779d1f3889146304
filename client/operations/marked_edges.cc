#include "client/operations/marked_edges.h"

namespace affskel::client {

std::vector<MarkedEdge> marked_edges(const core::Mesh& mesh, const std::vector<MeshDefect>& defects) {
  std::vector<MarkedEdge> marks;
  for (const MeshDefect& defect : defects)
    for (const DefectPlace& place : defect.places)
      for (const core::Segment& edge : place.edges)
        marks.push_back({mesh.points[edge[0]], mesh.points[edge[1]]});
  return marks;
}

}  // namespace affskel::client
