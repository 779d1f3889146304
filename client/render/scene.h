#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/base/stance.h"
#include "client/render/camera.h"
#include "client/render/image.h"
#include "client/render/legend.h"
#include "client/render/painted_body.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

struct RenderOptions {
  int width = 1600;                               ///< pixels, 200 .. 8000; the height follows from the shape
  std::vector<Camera> cameras = usual_cameras();  ///< one view each, 1 .. 6
  bool mesh = true;                               ///< draw the body
  /// For small pictures: no title, names and scales, and of the views the first that tells what the body is.
  bool bare = false;
  Rgb background = kWhite;
};

/// Edges of the body that stand out.
struct DefectMarks {
  ColourRow what;                    ///< for the legend
  std::vector<core::Segment> edges;  ///< of the body's points
};

/// What is on the picture.
struct RenderInput {
  core::Mesh mesh;                     ///< the body, drawn translucent
  std::optional<PaintedBody> painted;  ///< drawn instead; the skeleton then in one colour
  std::vector<DefectMarks> marks;      ///< drawn over it; may be empty
  v1::SkeletonPoints skeleton;  ///< drawn as balls, stretched like the cells, coloured by E; may be empty
  v1::TriangleMesh
      sheet;  ///< of `chords` or `ridge`, drawn as a surface, with curves, coloured by E; may be empty
  v1::TriangleMesh eroded;         ///< the eroded solid's surface, drawn translucent; may be empty
  std::string level;               ///< what the eroded solid is, for the legend; with one
  std::array<core::Vec3, 3> cell;  ///< steps of the lattice, mesh units; give the balls' size and shape
  double volume = 0;               ///< v0, mesh units cubed; E is labelled as a share of it
  core::Stance stance;             ///< of the body
  std::string title;               ///< one line above the views
};

/// Orthographic views at one scale, with a scale bar in mesh units and the scale of colours for E, arranged
/// so that they fill the picture.
/// @throws ClientError kUsage when the width or the number of cameras is out of range, kBadInput when the
///   mesh is empty.
Image render_scene(const RenderInput& input, const RenderOptions& options = {});

/// The colour of "#RGB", "#RRGGBB", "white", "black" or "dark" (that of pages).
/// @throws ClientError kUsage for anything else.
Rgb parse_background(const std::string& text);

}  // namespace affskel::client
