#include "client/files/shape_file.h"

#include <algorithm>

namespace affskel::client {

const PointColumn* ShapeFile::column(std::string_view name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const PointColumn& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

}  // namespace affskel::client
