#pragma once

#include <string>
#include <vector>

#include "client/base/notice.h"
#include "client/files/read/input_file.h"
#include "core/mesh/mesh.h"
#include "core/repair/repair_mesh.h"

namespace affskel::client {

/// How a mesh is made to bound a solid.
struct RepairChoice {
  enum class Kind {
    kNone,  ///< not at all: what does not bound a solid is refused
    kAuto,  ///< mended; holes are filled that are no longer than a share of the box's diagonal
    kFill,  ///< mended; holes are filled up to a length
    kWrap,  ///< wrapped
  };
  Kind kind = Kind::kAuto;
  double longest_hole = 0;  ///< of kFill, mesh units
  double alpha = 0;         ///< of kWrap, mesh units; 0: see RepairOptions
};

/// A mesh that bounds a solid, and what that took.
struct Repair {
  core::Mesh mesh;
  std::vector<core::RepairStep> steps;  ///< none: the mesh did so already
  double filled_share = 0;              ///< of the surface: what fills holes
  double volume = 0;                    ///< mesh units cubed; 0 where something is left
  std::string left;         ///< why the mesh bounds no solid yet: holes that are longer, or too much of the
                            ///< surface, than is filled unasked; empty: it does
  double longest_left = 0;  ///< what fills those: a length, mesh units; 0: none does
};

/// @param file for messages.
/// @throws ClientError kBadInput where it bounds no solid for other reasons.
Repair repair(const core::Mesh& mesh, const std::string& file, const RepairChoice& choice,
              core::ExecutionContext* context = nullptr);

/// What of a repair is likely not as its user wants it.
Notices repair_warnings(const std::vector<core::RepairStep>& steps, const std::string& file);

/// What is wrong with a mesh that bounds a solid, and no repair but a wrap mends, such as surfaces that cross each other.
Notices solid_warnings(const core::Mesh& mesh, const std::string& file);

/// What a mesh was before its repair, and what was done to it.
struct MeshSource {
  std::string bytes;  ///< OFF text
  std::vector<core::RepairStep> steps;
};

/// Puts the repaired mesh in the place of the one that was read.  @return what that was.
MeshSource replace_mesh(InputFile& input, Repair repaired);

}  // namespace affskel::client
