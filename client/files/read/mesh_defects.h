#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/text/off_file.h"

namespace affskel::client {

/// Where a defect is.
struct DefectPlace {
  std::uint64_t line = 0;  ///< of the file, counted from 1; 0 where the format has none
  std::uint32_t triangle = 0;
  std::string detail;                ///< ", vertices 3 and 7" or empty
  std::vector<core::Segment> edges;  ///< of the mesh's points: the edge, or all of the triangle
};

/// So many places of each kind of defect are told where all are not asked for.
inline constexpr std::size_t kFewPlaces = 5;

/// A kind of defect that keeps a mesh from bounding a solid.
struct MeshDefect {
  std::string name;  ///< one of them: "open edge"
  std::string code;  ///< "open-edges", "crowded-edges", "repeated-triangles", "degenerate-triangles"
  std::uint64_t count = 0;
  std::string cause;                ///< "edges have a triangle on one side only (a hole)"
  std::vector<DefectPlace> places;  ///< the first ones, or all
};

/// "line 12, triangle 5, vertices 3 and 7".
std::string place_text(const DefectPlace& place);

/// "412 edges have a triangle on one side only (a hole): line 12, ...; line 14, ...; and 410 more".
std::string defect_text(const MeshDefect& defect);

/// Every kind of topological defect, with its first `max_places` places.  Coincident vertices count as one,
/// as in the repair.
std::vector<MeshDefect> find_defects(const core::OffMesh& off, std::size_t max_places = kFewPlaces);

}  // namespace affskel::client
