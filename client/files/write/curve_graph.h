#pragma once

#include <cstdint>
#include <vector>

#include "client/base/shape_file.h"

namespace affskel::client {

/// A line between two nodes.
struct CurveBranch {
  std::uint32_t from = 0, to = 0;       ///< nodes; the same for a loop
  std::vector<std::uint32_t> vertices;  ///< from one to the other
  double length = 0;                    ///< along the line, mesh units
  double straight_length = 0;           ///< from node to node
  double share = 0;  ///< of the volume: of its vertices, and of a node's its part among the branches there
  double mean_radius = 0, least_radius = 0, greatest_radius = 0;  ///< mean along the line
};

/// A curve skeleton as a graph.
struct CurveGraph {
  std::vector<std::uint32_t>
      nodes;  ///< vertices: ends, places where lines meet, one of each loop without these,
              ///< and vertices without a line; ascending
  std::vector<std::uint32_t> degree;  ///< per node: ends of branches there
  std::vector<CurveBranch> branches;
};

/// @param shape with segments and the columns radius and share.
/// @throws ClientError kInternal when it lacks one.
CurveGraph curve_graph(const ShapeFile& shape);

/// A column that a curve must have.  @throws ClientError kInternal when it has not.
const std::vector<double>& curve_column(const ShapeFile& shape, const char* name);

}  // namespace affskel::client
