#include "client/artifacts/field_writer.h"

#include <array>
#include <limits>

namespace affskel::client {

FieldWriter::FieldWriter(FileFormat format, base::AtomicFile& file, const LatticePoints& points)
    : table_(format, file, points,
             {{"E", {"E"}, false, std::numeric_limits<double>::quiet_NaN()},
              {"normal", {"nx", "ny", "nz"}, false, 0},
              {"direction", {"direction"}, true, -1}}) {}

void FieldWriter::put(const FieldPoint& point) {
  table_.put(point, std::array{point.erosion, point.normal.x, point.normal.y, point.normal.z,
                               static_cast<double>(point.direction)});
}

}  // namespace affskel::client
