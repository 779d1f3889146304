#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

enum class RepairKind {
  kMend,  ///< weld, orient, separate, fill holes, drop flaps; what is sound stays as it is
  kWrap,  ///< a new surface round all of it and in its cavities, for what cannot be mended, or that of the surface
          ///< through points alone; see wrap_solid, cloud_surface
};

struct RepairOptions {
  RepairKind kind = RepairKind::kMend;
  double longest_hole = 0;  ///< of a boundary loop that is filled, mesh units; 0: 0.6 of the box's diagonal
  double alpha =
      0;  ///< of a wrap, mesh units; 0: a 220th of the box's diagonal, no less than a cloud's spacing
  double offset = 0;  ///< of a wrap, mesh units; 0: a tenth of alpha
  ExecutionContext* context = nullptr;
};

/// One thing that was done.
struct RepairStep {
  /// Stable: "welded-points", "joined-points", "unused-points", "degenerate-triangles", "repeated-triangles",
  /// "t-junctions", "turned-triangles", "separated-points", "stitched-edges", "filled-holes", "bent-fillings", "flaps",
  /// "turned-out", "turned-cavities", "lone-points", "surfaced", "wrapped", "closed-cavities", "wrap-volume".
  std::string code;
  std::uint64_t count = 0;
  std::string message;  ///< with counts, lengths and places
  MeshNote::Severity severity =
      MeshNote::Severity::kRepaired;  ///< a warning: likely not as its user wants it
};

/// Whether what was done is likely not as its user wants it.
inline bool is_warning(const RepairStep& step) {
  return step.severity == MeshNote::Severity::kWarning;
}

struct RepairedMesh {
  Mesh mesh;  ///< bounds a solid, see make_solid, or `left` says why not
  std::vector<RepairStep> steps;
  double filled_share = 0;    ///< of the surface's area: what fills holes
  double longest_filled = 0;  ///< length round the longest hole that was filled, mesh units
  double longest_left = 0;    ///< length round the longest hole that is left, mesh units; 0: no length helps
  double volume = 0;          ///< mesh units cubed; 0 where something is left
  double wrapped_volume = 0;  ///< of the solid that was wrapped, mesh units cubed; 0: none, or unknown
  bool wrapped_overlaps = false;  ///< of that what overlaps counts twice: mostly it is less
  double bulge = 0;  ///< volume between what fills holes and soap films in them, mesh units cubed
  std::string left;  ///< what it still lacks, with what would help; empty: nothing
};

/// Makes a mesh bound a solid, in steps that are told.
/// @throws CoreError kBadInput without points, or with all of them at one place; for an open flat sheet, or a wrap
///   that is a film about open sheets, unless an alpha was asked for; for a box of 1e60 or more, of 1e-60 or less;
///   for an alpha below a 2000th of its diagonal, or above all of it; as cloud_surface and alpha_wrap. kCancelled.
RepairedMesh repair_mesh(const Mesh& mesh, const RepairOptions& options = {});

}  // namespace affskel::core
