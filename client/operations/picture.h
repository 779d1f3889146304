#pragma once

#include <string>

#include "client/base/notice.h"
#include "client/base/stance.h"
#include "client/connection/session.h"
#include "client/operations/skeleton_choice.h"
#include "client/render/scene.h"

namespace affskel::client {

/// What the colours of a picture tell: E on the skeleton, or of the body the part that each triangle belongs to, or how
/// thick it is there.
enum class PictureColour { kErosion, kPart, kThickness };

/// What a picture is to show.
struct PictureOptions {
  PictureColour colour = PictureColour::kErosion;
  SkeletonChoice skeleton;
  double level = 0;     ///< of the eroded solid that is drawn, as a share of v0; 0 = none
  StanceChoice stance;  ///< what is chosen is kept with the job
  RenderOptions render;
};

struct Picture {
  std::string png;    ///< bytes of the file
  std::string shown;  ///< the skeleton in words: "sheet of 2123 triangles (ridge, threshold 5)"
  Notices notices;    ///< that there is no skeleton, or no eroded solid
};

/// The picture of a finished job: the body with its skeleton as points, of `chords` and `ridge` with its
/// sheet; of parts with the curve skeleton.
Picture make_picture(Session& session, const v1::Job& job, const PictureOptions& options);

}  // namespace affskel::client
