#include <limits>

#include "client/files/write/field_writer.h"
#include "client/files/write/vtkhdf_image.h"

namespace affskel::client {
namespace {

class VtkHdfWriter : public FieldWriter {
 public:
  VtkHdfWriter(AtomicFile& file, const LatticePoints& points)
      : image_(file, points),
        erosion_(image_.add("E", 1, std::numeric_limits<double>::quiet_NaN())),
        normal_(image_.add("normal", 3, 0.0)),
        direction_(image_.add("direction", 1, std::int32_t{-1})),
        inside_(image_.add("inside", 1, std::uint8_t{0})) {}

  void put(const FieldPoint& p) override {
    image_.enter(p.i);
    erosion_.at(p.i, p.j, p.k) = p.erosion;
    direction_.at(p.i, p.j, p.k) = static_cast<std::int32_t>(p.direction);
    inside_.at(p.i, p.j, p.k) = 1;
    for (unsigned c = 0; c < 3; ++c) normal_.at(p.i, p.j, p.k, c) = p.normal[static_cast<int>(c)];
  }

  void finish() override { image_.finish(); }

 private:
  VtkHdfImage image_;
  VtkHdfArray<double>&erosion_, &normal_;
  VtkHdfArray<std::int32_t>& direction_;
  VtkHdfArray<std::uint8_t>& inside_;
};

}  // namespace

std::unique_ptr<FieldWriter> make_vtkhdf_writer(AtomicFile& file, const LatticePoints& points) {
  return std::make_unique<VtkHdfWriter>(file, points);
}

}  // namespace affskel::client
