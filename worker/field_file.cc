#include "field_file.h"

#include <cmath>
#include <cstdio>

#include "base/atomic_file.h"
#include "core/base/error.h"

namespace affskel::worker {
namespace {

bool ends_with(const std::string& text, const std::string& tail) {
  return text.size() >= tail.size() && text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

// 17 significant digits.
void append_number(std::string& line, double number) {
  char digits[32];
  line.append(digits, static_cast<std::size_t>(std::snprintf(digits, sizeof digits, "%.17g", number)));
}

}  // namespace

void check_field_file(const std::string& path) {
  if (ends_with(path, ".csv") || ends_with(path, ".dat")) return;
  throw core::CoreError(core::CoreError::Code::kBadInput,
                        "output " + path + ": the extension must be .csv or .dat");
}

void write_field_file(const std::string& path, const core::Solid& solid, const core::Lattice& lattice,
                      const core::DirectionSet& directions, const core::ErosionField& field) {
  base::AtomicFile file(path);
  const bool csv = ends_with(path, ".csv");
  if (csv) file.write("x,y,z,E,nx,ny,nz,direction\n");
  const core::SamplePlaces places(solid, lattice);
  std::string line;
  const double volume_unit = std::ldexp(1.0, 3 * solid.exponent);
  for (const core::LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const core::Vec3 x = places.at(run.start[0], run.start[1], run.start[2] + n);
      const core::FieldValue value = field.value(run.first + n);
      const core::Vec3& d = directions[value.direction];
      const double erosion = value.erosion * volume_unit;
      for (const double number : {x.x, x.y, x.z, erosion, d.x, d.y}) {
        append_number(line, number);
        line += csv ? ',' : ' ';
      }
      append_number(line, d.z);
      if (csv) line += ',' + std::to_string(value.direction);
      line += '\n';
      file.write(line);
      line.clear();
    }
  }
  file.commit();
}

}  // namespace affskel::worker
