#include "core/files/lattice_table.h"

#include <stdexcept>

#include "core/base/error.h"
#include "core/files/numbers.h"
#include "core/files/vtk_xml_grid.h"
#include "core/files/vtkhdf_grid.h"

namespace affskel::core {
namespace {

class TextOutput : public LatticeTable {
 public:
  // @param csv else .dat.
  TextOutput(base::AtomicFile& file, bool csv, const LatticeGrid& lattice,
             const std::vector<LatticeColumn>& columns)
      : file_(file), separator_(csv ? ',' : ' '), lattice_(lattice) {
    std::string header = "x,y,z";
    for (const LatticeColumn& column : columns) {
      const bool shown = column.in_text && (csv || column.type == GridType::kFloat64);
      shown_.insert(shown_.end(), column.components.size(), shown);
      if (!shown) continue;
      for (const std::string& component : column.components) header += "," + component;
    }
    if (csv) file_.write(header + "\n");
  }

  void put(const LatticePlace& at, std::span<const double> values) override {
    row_.clear();
    const Vec3 place = grid_place(lattice_, at[0], at[1], at[2]);
    for (int c = 0; c < 3; ++c) append(place[c]);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (shown_[i]) append(values[i]);
    }
    row_.back() = '\n';
    file_.write(row_);
  }

 private:
  void append(double value) {
    append_exact(row_, value);
    row_.push_back(separator_);
  }

  base::AtomicFile& file_;
  char separator_;
  LatticeGrid lattice_;
  std::vector<bool> shown_;  // per value of a row
  std::string row_;
};

LatticeGrid grid_around(const LatticeGrid& lattice) {
  LatticeGrid grid;
  for (std::size_t a = 0; a < 3; ++a) grid.dims[a] = lattice.dims[a] + 2;
  grid.origin = lattice.origin - (lattice.axes[0] + (lattice.axes[1] + lattice.axes[2]));
  grid.axes = lattice.axes;
  return grid;
}

class GridOutput : public LatticeTable {
 public:
  GridOutput(FileFormat format, base::AtomicFile& file, const LatticeGrid& lattice,
             const std::vector<LatticeColumn>& columns, const FileFacts& facts)
      : grid_(grid_around(lattice)), planes_(grid_.dims, blank_of(columns)) {
    std::vector<GridArray> arrays;
    for (const LatticeColumn& column : columns) {
      arrays.push_back({column.name, column.type, column.components.size(), inside_});
      inside_ += column.components.size();
    }
    arrays.push_back({"inside", GridType::kUint8, 1, inside_});
    const bool hdf = format == FileFormat::kVtkHdf || format == FileFormat::kHdf;
    file_ = hdf ? make_vtkhdf_grid(file, grid_, std::move(arrays), facts)
                : make_vtk_xml_grid(file, grid_, format == FileFormat::kVts, std::move(arrays), facts);
  }

  void put(const LatticePlace& at, std::span<const double> values) override {
    // Outside values come up to two layers late.
    write_up_to(at[0] + 1 > 2 ? at[0] + 1 - 2 : 0);
    planes_.hold(at[0] + 1);
    for (std::size_t c = 0; c < values.size(); ++c) value_at(c, at) = values[c];
    value_at(inside_, at) = 1;
  }

  void put_outside(const std::array<std::int64_t, 3>& at, std::size_t component, double value) override {
    const auto i = static_cast<std::uint32_t>(at[0] + 1);
    if (i < planes_.begin()) throw std::logic_error("a value for a plane that is written");
    planes_.hold(i);
    planes_.at(component, i, static_cast<std::uint32_t>(at[1] + 1), static_cast<std::uint32_t>(at[2] + 1)) =
        value;
  }

  void finish() override {
    write_up_to(grid_.dims[0]);
    if (written_ < grid_.dims[0]) write(grid_.dims[0]);
    file_->finish();
  }

 private:
  static std::vector<double> blank_of(const std::vector<LatticeColumn>& columns) {
    std::vector<double> blank;
    for (const LatticeColumn& column : columns)
      blank.insert(blank.end(), column.components.size(), column.outside);
    blank.push_back(0);  // inside
    return blank;
  }

  double& value_at(std::size_t component, const LatticePlace& at) {
    return planes_.at(component, at[0] + 1, at[1] + 1, at[2] + 1);
  }

  // Writes while as many planes are known as the file takes at a time: those before `known`.
  void write_up_to(std::uint32_t known) {
    while (begin() + file_->planes_at_a_time() <= known && written_ < grid_.dims[0])
      write(begin() + file_->planes_at_a_time());
  }

  // The first plane of the next part.
  std::uint32_t begin() const { return written_ == 0 ? 0 : written_ - file_->overlap(); }

  void write(std::uint32_t end) {
    planes_.hold(end - 1);
    file_->write(planes_, begin(), end);
    written_ = end;
    planes_.drop(begin());
  }

  LatticeGrid grid_;
  GridPlanes planes_;
  std::size_t inside_ = 0;  // component
  std::unique_ptr<GridFile> file_;
  std::uint32_t written_ = 0;  // planes
};

}  // namespace

std::unique_ptr<LatticeTable> make_lattice_table(FileFormat format, base::AtomicFile& file,
                                                 const LatticeGrid& lattice,
                                                 const std::vector<LatticeColumn>& columns,
                                                 const FileFacts& facts) {
  check_places(format, lattice);
  switch (format) {
    case FileFormat::kCsv:
    case FileFormat::kDat:
      return std::make_unique<TextOutput>(file, format == FileFormat::kCsv, lattice, columns);
    case FileFormat::kVti:
    case FileFormat::kVts:
    case FileFormat::kVtkHdf:
    case FileFormat::kHdf:
      return std::make_unique<GridOutput>(format, file, lattice, columns, facts);
    default:
      throw std::logic_error("no writer of sample points for " + std::string(extension_of(format)));
  }
}

void check_places(FileFormat format, const LatticeGrid& lattice) {
  if (format != FileFormat::kVti || is_upright(lattice)) return;
  refuse(
      "the lattice is turned or sheared, and .vti has no place for that; take .vts, which holds the points");
}

}  // namespace affskel::core
