#include "core/files/field_file.h"

#include <array>
#include <span>

namespace affskel::core {
namespace {

constexpr std::size_t kErosion = 0, kShare = 1;  // components

std::vector<LatticeColumn> field_columns(const FieldColumns& wanted) {
  std::vector<LatticeColumn> columns = {
      {"E", {"E"}}, {"E_share", {"E_share"}, GridType::kFloat64, 0, false}, {"normal", {"nx", "ny", "nz"}}};
  if (wanted.all_directions) {
    columns.push_back({"slope", {"slope"}});
    columns.push_back({"saddles", {"saddles"}, GridType::kInt32, -1});
  } else {
    columns.push_back({"direction", {"direction"}, GridType::kInt32, -1});
  }
  if (wanted.parts) columns.push_back({"part", {"part"}, GridType::kInt32, 0});
  return columns;
}

}  // namespace

FieldFile::FieldFile(FileFormat format, base::AtomicFile& file, const LatticeGrid& lattice, double volume,
                     const FileFacts& facts, const FieldColumns& columns)
    : table_(make_lattice_table(format, file, lattice, field_columns(columns), facts)),
      axes_(lattice.axes),
      volume_(volume),
      columns_(columns) {
  if (format == FileFormat::kCsv || format == FileFormat::kDat) return;
  outside_.emplace(lattice.dims, [this](const PlaceAround& at, double erosion) {
    table_->put_outside(at, kErosion, erosion);
    table_->put_outside(at, kShare, erosion / volume_);
  });
}

void FieldFile::put(const LatticePlace& at, const FieldSample& sample) {
  const Vec3& n = sample.normal;
  const Vec3 slopes = sample.slope * Vec3{dot(n, axes_[0]), dot(n, axes_[1]), dot(n, axes_[2])};
  if (outside_)
    outside_->put(at, sample.erosion, slopes);  // first: the table then writes what is before the point
  std::array<double, 8> values{sample.erosion, sample.erosion / volume_, n.x, n.y, n.z};
  std::size_t count = 5;
  if (columns_.all_directions) {
    values[count++] = sample.slope;
    values[count++] = static_cast<double>(sample.saddles);
  } else {
    values[count++] = static_cast<double>(sample.direction);
  }
  if (columns_.parts) values[count++] = static_cast<double>(sample.part);
  table_->put(at, std::span(values).first(count));
}

void FieldFile::finish() {
  if (outside_) outside_->finish();
  table_->finish();
}

}  // namespace affskel::core
