#pragma once

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/base/stance.h"
#include "client/view/view_points.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

/// An edge that stands out: of a defect of the mesh, or of one that its repair has mended.
struct MarkedEdge {
  core::Vec3 from, to;
};

/// A body with its skeleton and eroded solids.
struct ViewModel {
  v1::Job job;                     ///< its name, id, and what was prepared
  core::Mesh mesh;                 ///< the body, drawn as glass
  std::string operator_name;       ///< e.g. "zucker-hummel"
  double threshold = 0;            ///< the slider stands there at first; the operator's unit
  ViewGrid grid;                   ///< of the points
  ViewSelection selection;         ///< how they were chosen
  std::vector<ViewPoint> points;   ///< by descending |H|; none where the sheet is the skeleton
  bool sheet_is_skeleton = false;  ///< operator `chords` or `ridge`: there is no |H|
  v1::TriangleMesh sheet;  ///< then: with E and strength; triangles, and segments of curves, possibly none
  v1::SolidParts parts;    ///< of the mesh's triangles; or none
  std::vector<MarkedEdge> marks;
  v1::SkeletonQuality quality;           ///< of the skeleton; empty when the server told none
  std::vector<v1::TriangleMesh> eroded;  ///< per level of the page: the surface that `erode` makes
};

/// What is on a page.
struct ViewInput {
  std::vector<ViewModel> models;  ///< one, or two side by side with one camera
  core::Stance stance;            ///< of all
  std::vector<double> levels;     ///< of the eroded solids, shares of v0, ascending; may be empty
  std::size_t first_level = 0;    ///< where the slider stands at first
  bool show_level = false;        ///< whether the eroded solid is shown at first
  bool mesh_only = false;         ///< one mesh without a job
};

/// E of the last colour, as a share of v0: the highest on any of the skeletons.
double highest_share(const std::vector<ViewModel>& models);

/// One self-contained HTML page with the data, the program that shows them and three.js; it asks for nothing
/// from anywhere.
/// @throws ClientError kBadInput when a mesh is empty; std::logic_error unless there are one or two models.
std::string view_page(const ViewInput& input);

/// The Content-Security-Policy for sending such a page over HTTP, into a frame of the same origin: it runs in
/// a sandbox and may do no more than its own script and style, which the policy names by their hashes, and
/// hand the user a picture.
std::string view_page_policy();

}  // namespace affskel::client
