#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct SolidOptions {
  /// Weld equal vertices, turn faces to agree, drop what nothing uses, leave out specks; false: refuse.
  bool repair = true;
  bool check_self_intersections = true;
  unsigned threads = 1;                 ///< >= 1; the solid does not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// One thing worth telling about a mesh.
struct MeshNote {
  enum class Severity { kRepaired, kWarning };
  Severity severity = Severity::kWarning;
  std::string code;     ///< stable: "unused-vertices", "welded", "degenerate-triangles", "reoriented",
                        ///< "split-vertices", "specks", "turned-out", "turned-cavities", "copies",
                        ///< "self-intersecting"
  std::string message;  ///< counts and the first place
};

/// As messages and JSON name it: "repaired" or "warning".
constexpr const char* severity_word(MeshNote::Severity severity) {
  return severity == MeshNote::Severity::kWarning ? "warning" : "repaired";
}

/// One closed surface of a solid's boundary.
struct Shell {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  std::int64_t genus = 0;
  double volume = 0;        ///< signed, mesh units cubed: < 0 for a cavity's wall
  std::uint32_t solid = 0;  ///< index of the solid it bounds
  bool cavity = false;
};

/// A solid V bounded by closed outward-oriented triangle meshes, ready for the erosion.
///
/// Scaled coordinates: y = (x - centre) * 2^-exponent, so that the bounding box is centred at 0 and its
/// longest side lies in (1/2, 1].  The scaling is exact, the shift rounds once; all further stages work in
/// scaled coordinates and give volumes times 2^(3 exponent), areas times 2^(2 exponent).
struct Solid {
  Mesh mesh;                                  ///< scaled coordinates
  Vec3 centre;                                ///< of the bounding box, mesh units
  int exponent = 0;                           ///< see above
  Vec3 bbox_min, bbox_max;                    ///< mesh units
  std::vector<Shell> shells;                  ///< by first triangle
  std::vector<std::uint32_t> triangle_shell;  ///< per triangle
  std::vector<double> solid_volume;           ///< per connected solid, mesh units cubed, > 0
  double volume = 0;                          ///< v0: all solids, mesh units cubed
  bool self_intersecting = false;             ///< triangles cross or touch that are not neighbours
  bool surfaces_meet = false;                 ///< such triangles are of different shells
  /// Pairs of triangles that pass through each other, (i, j) with i < j, ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings;
  std::vector<MeshNote> notes;

  /// Mesh units per scaled unit, 2^exponent.
  double scale() const { return std::ldexp(1.0, exponent); }
  /// A volume in scaled coordinates.
  double scaled(double mesh_volume) const { return std::ldexp(mesh_volume, -3 * exponent); }

  /// Whether two triangles that cross are of one surface, which is folded then, as noise does it; parts of a model that
  /// overlap are meant to.
  bool is_fold(const std::pair<std::uint32_t, std::uint32_t>& crossing) const {
    return triangle_shell[crossing.first] == triangle_shell[crossing.second];
  }
  bool is_folded() const {
    return std::any_of(crossings.begin(), crossings.end(),
                       [&](const auto& crossing) { return is_fold(crossing); });
  }

  /// The connected solid that a triangle bounds.
  std::uint32_t solid_of(std::uint32_t triangle) const { return shells[triangle_shell[triangle]].solid; }
};

/// The connected solids, those joined whose surfaces pass through each other.
DisjointSets joined_solids(const Solid& solid);

/// Checks that the mesh bounds a solid and normalises it.
/// @param vertex_line, triangle_line lines for messages (see OffMesh); may be empty.
/// @throws CoreError kBadInput with the first place and cause: no triangles, open edges, edges with more
///   than two triangles, repeated triangles, not orientable, zero volume (but see find_specks), solids so far
///   apart that their volumes cannot be told from rounding, coordinates so large or small that the volume is
///   not a normal double.  kCancelled when the context asks to stop.
Solid make_solid(const Mesh& mesh, const SolidOptions& options = {},
                 const std::vector<std::uint32_t>& vertex_line = {},
                 const std::vector<std::uint32_t>& triangle_line = {});

}  // namespace affskel::core
