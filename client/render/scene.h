#pragma once

#include <array>
#include <string>

#include "affskel/v1/types.pb.h"
#include "client/render/image.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

struct RenderOptions {
  int width = 1600;  ///< pixels, 200 .. 8000; the height follows from the shape
};

/// What is on the picture.
struct RenderInput {
  core::Mesh mesh;              ///< the body, drawn translucent
  v1::SkeletonPoints skeleton;  ///< drawn as balls, stretched like the cells, coloured by E; may be empty
  v1::TriangleMesh
      sheet;  ///< of `chords` or `ridge`, drawn as a surface, with curves, coloured by E; may be empty
  std::array<core::Vec3, 3> cell;  ///< steps of the lattice, mesh units; give the balls' size and shape
  double volume = 0;               ///< v0, mesh units cubed; E is labelled as a share of it
  std::string title;               ///< one line above the panels
};

/// Three orthographic views at one scale, from the front (looking along +y), from the side (looking along -x)
/// and from above, with a scale bar in mesh units and a colour bar for E.
/// @throws ClientError kUsage when the width is out of range, kBadInput when the mesh is empty.
Image render_scene(const RenderInput& input, const RenderOptions& options = {});

}  // namespace affskel::client
