#pragma once

#include <vector>

#include "client/base/shape_file.h"
#include "core/curve/curve_graph.h"

namespace affskel::client {

/// A curve skeleton as a graph: its branches are the solid's parts.  A point, of one vertex, is no branch of a file.
/// @param shape with segments and the columns radius, distance and share.
/// @throws ClientError kInternal when it lacks one.
core::CurveGraph curve_graph(const ShapeFile& shape);

/// A column that a curve must have.  @throws ClientError kInternal when it has not.
const std::vector<double>& curve_column(const ShapeFile& shape, const char* name);

}  // namespace affskel::client
