#pragma once

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/view/view_points.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

/// What is on a page.
struct ViewInput {
  v1::Job job;                     ///< its name, id, and what was prepared
  core::Mesh mesh;                 ///< the body, drawn as glass
  std::string operator_name;       ///< e.g. "zucker-hummel"
  double threshold = 0;            ///< the slider stands there at first; the operator's unit
  ViewGrid grid;                   ///< of the points
  ViewSelection selection;         ///< how they were chosen
  std::vector<ViewPoint> points;   ///< by descending |H|
  bool sheet_is_skeleton = false;  ///< operator `chords` or `ridge`: there is no |H|
  v1::TriangleMesh sheet;  ///< then: with E and strength; triangles, and segments of curves, possibly none
};

/// The axis that points up on a page: z, as in this project's pictures, unless the box is much longer along
/// y than along both others, as models that stand along y are.
char up_axis(const core::Vec3& box_size);

/// One self-contained HTML page with the data, the program that shows them and three.js; it asks for nothing
/// from anywhere.
/// @throws ClientError kBadInput when the mesh is empty.
std::string view_page(const ViewInput& input);

/// The Content-Security-Policy for sending such a page over HTTP, into a frame of the same origin: it runs in
/// a sandbox and may do no more than its own script and style, which the policy names by their hashes.
std::string view_page_policy();

}  // namespace affskel::client
