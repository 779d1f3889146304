// VTK XML (VTK User's Guide, "XML File Formats"), ImageData and StructuredGrid.
#include "core/files/vtk_xml_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/coding.h"
#include "base/number_text.h"
#include "core/files/vtk_inline_data.h"
#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {
namespace {

std::string type_name(GridType type) {
  return type == GridType::kFloat64 ? "Float64" : type == GridType::kInt32 ? "Int32" : "UInt8";
}

void append_as(std::string& bytes, double value, GridType type) {
  switch (type) {
    case GridType::kFloat64:
      return base::append(bytes, value);
    case GridType::kInt32:
      return base::append(bytes, static_cast<std::int32_t>(value));
    case GridType::kUint8:
      return base::append(bytes, static_cast<std::uint8_t>(value));
  }
}

std::string texts(const Vec3& v) {
  return base::to_text(v.x) + " " + base::to_text(v.y) + " " + base::to_text(v.z);
}

class VtkXmlGrid : public GridFile {
 public:
  VtkXmlGrid(base::AtomicFile& file, const LatticeGrid& grid, bool points, std::vector<GridArray> arrays,
             const FileFacts& facts, std::uint64_t piece_places)
      : file_(file),
        grid_(grid),
        kind_(points ? "StructuredGrid" : "ImageData"),
        points_(points),
        arrays_(std::move(arrays)) {
    if (!points && !is_upright(grid)) throw std::logic_error("an image of a turned grid");
    const std::uint64_t in_plane = std::uint64_t{grid.dims[1]} * grid.dims[2];
    planes_ = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(piece_places / in_plane, std::min(2U, grid.dims[0]), grid.dims[0]));
    write_head(facts);
  }

  std::uint32_t planes_at_a_time() const override { return planes_; }
  std::uint32_t overlap() const override { return 1; }

  void write(const GridPlanes& planes, std::uint32_t begin, std::uint32_t end) override {
    file_.write("<Piece Extent=\"" + extent(begin, end) + "\">\n<PointData Scalars=\"" +
                arrays_.front().name + "\">\n");
    for (const GridArray& array : arrays_) {
      bytes_.clear();
      for_each_value(array, grid_.dims, planes, begin, end,
                     [&](double value) { append_as(bytes_, value, array.type); });
      write_array(type_name(array.type), array.name, array.components);
    }
    file_.write("</PointData>\n<CellData>\n</CellData>\n");
    if (points_) write_points(begin, end);
    file_.write("</Piece>\n");
  }

  void finish() override { file_.write("</" + kind_ + ">\n</VTKFile>\n"); }

 private:
  std::string extent(std::uint32_t begin, std::uint32_t end) const {
    return std::to_string(begin) + " " + std::to_string(end - 1) + " 0 " + std::to_string(grid_.dims[1] - 1) +
           " 0 " + std::to_string(grid_.dims[2] - 1);
  }

  void write_head(const FileFacts& facts) {
    file_.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind_ +
                "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
                "compressor=\"vtkZLibDataCompressor\">\n<" +
                kind_ + " WholeExtent=\"" + extent(0, grid_.dims[0]) + "\"");
    if (!points_) {
      const Vec3 spacing{grid_.axes[0].x, grid_.axes[1].y, grid_.axes[2].z};
      file_.write(" Origin=\"" + texts(grid_.origin) + "\" Spacing=\"" + texts(spacing) + "\"");
    }
    file_.write(">\n<FieldData>\n");
    for (const FileFact& fact : facts) write_fact(fact);
    file_.write("</FieldData>\n");
  }

  void write_fact(const FileFact& fact) {
    bytes_.clear();
    if (fact.number) base::append(bytes_, *fact.number);
    if (!fact.number) bytes_ = fact.text + '\0';
    const std::string tag = fact.number ? "DataArray" : "Array";
    file_.write("<" + tag + " type=\"" + (fact.number ? "Float64" : "String") + "\" Name=\"" + fact.key +
                "\" NumberOfTuples=\"1\" format=\"binary\">\n" + vtk_inline_compressed(bytes_) + "\n</" +
                tag + ">\n");
  }

  // Places are functions of the grid: single precision where it keeps them within a thousandth of a step, in half the
  // bytes.
  bool single_precision() const {
    double farthest = 0, step = norm(grid_.axes[0]);
    for (const Vec3& axis : grid_.axes) step = std::min(step, norm(axis));
    for (unsigned corner = 0; corner < 8; ++corner) {
      const auto end = [&](std::size_t a) { return (corner >> a & 1) != 0 ? grid_.dims[a] : 0; };
      const Vec3 place = grid_place(grid_, end(0), end(1), end(2));
      for (int c = 0; c < 3; ++c) farthest = std::max(farthest, std::fabs(place[c]));
    }
    return farthest <= 1e-3 * step / std::numeric_limits<float>::epsilon();
  }

  void write_points(std::uint32_t begin, std::uint32_t end) {
    bytes_.clear();
    const bool single = single_precision();
    for (std::uint32_t k = 0; k < grid_.dims[2]; ++k) {
      for (std::uint32_t j = 0; j < grid_.dims[1]; ++j) {
        for (std::uint32_t i = begin; i < end; ++i) {
          const Vec3 place = grid_place(grid_, i, j, k);
          for (int c = 0; c < 3; ++c) {
            if (single) base::append(bytes_, static_cast<float>(place[c]));
            if (!single) base::append(bytes_, place[c]);
          }
        }
      }
    }
    file_.write("<Points>\n");
    write_array(single ? "Float32" : "Float64", "Points", 3);
    file_.write("</Points>\n");
  }

  // bytes_ as an array.
  void write_array(const std::string& type, const std::string& name, std::size_t components) {
    file_.write("<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                std::to_string(components) + "\" format=\"binary\">\n" + vtk_inline_compressed(bytes_) +
                "\n</DataArray>\n");
  }

  base::AtomicFile& file_;
  const LatticeGrid& grid_;
  std::string kind_;
  bool points_;
  std::vector<GridArray> arrays_;
  std::uint32_t planes_ = 1;
  std::string bytes_;  // of the array in hand
};

}  // namespace

std::unique_ptr<GridFile> make_vtk_xml_grid(base::AtomicFile& file, const LatticeGrid& grid, bool points,
                                            std::vector<GridArray> arrays, const FileFacts& facts,
                                            std::uint64_t piece_places) {
  return std::make_unique<VtkXmlGrid>(file, grid, points, std::move(arrays), facts, piece_places);
}

}  // namespace affskel::core
