#include "client/files/write/curve_graph.h"

#include <string>

#include "client/base/error.h"

namespace affskel::client {

const std::vector<double>& curve_column(const ShapeFile& shape, const char* name) {
  const PointColumn* column = shape.column(name);
  if (column == nullptr)
    throw ClientError(ExitCode::kInternal, std::string("the curve has no ") + name + " at its vertices");
  return column->values;
}

core::CurveGraph curve_graph(const ShapeFile& shape) {
  return core::curve_graph(shape.mesh().points, shape.segments, curve_column(shape, "radius"),
                           curve_column(shape, "share"));
}

}  // namespace affskel::client
