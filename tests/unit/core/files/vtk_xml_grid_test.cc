#include "core/files/vtk_xml_grid.h"

#include <array>
#include <sstream>

#include "core/files/vtk_inline_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"
#include "tools/vtk_xml_file.h"

namespace affskel::core {
namespace {

// No two values of a component are equal, also as whole numbers of 8 bits where there are few enough.
double value_of(std::size_t component, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  return double(component * 1000 + i * 36 + j * 6 + k);
}

const std::vector<GridArray> kArrays = {{"E", GridType::kFloat64, 1, 0},
                                        {"normal", GridType::kFloat64, 3, 1},
                                        {"direction", GridType::kInt32, 1, 4}};

struct Written {
  LatticeGrid grid;
  tests::VtkXmlFile file;
};

// A grid of 7 x 4 x 5 places, written in pieces of about so many places.
Written written(bool points, std::uint64_t piece_places, const LatticeGrid& grid) {
  GridPlanes planes(grid.dims, std::vector<double>(5, -1));
  planes.hold(grid.dims[0] - 1);
  for (std::size_t c = 0; c < 5; ++c) {
    for (std::uint32_t i = 0; i < grid.dims[0]; ++i) {
      for (std::uint32_t j = 0; j < grid.dims[1]; ++j) {
        for (std::uint32_t k = 0; k < grid.dims[2]; ++k) planes.at(c, i, j, k) = value_of(c, i, j, k);
      }
    }
  }
  const tests::TemporaryDirectory dir;
  base::AtomicFile out(dir / "grid");
  const FileFacts facts = {{"job", "0123"}, {"v0", "2.5", 2.5}, {"content", "<a> & \"b\""}};
  const auto file = make_vtk_xml_grid(out, grid, points, kArrays, facts, piece_places);
  EXPECT_EQ(file->overlap(), 1u);
  const std::uint32_t step = file->planes_at_a_time();
  std::uint32_t begin = 0;
  for (; begin + step < grid.dims[0]; begin += step - 1) file->write(planes, begin, begin + step);
  file->write(planes, begin, grid.dims[0]);
  file->finish();
  out.commit();
  return {grid, tests::VtkXmlFile(tests::read_file(dir / "grid"))};
}

LatticeGrid upright() {
  return {{0.1, -2, 1e6}, {{{0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 2}}}, {7, 4, 5}};
}

LatticeGrid sheared() {
  return {{0.1, -2, 1e6}, {{{2, 0, 0.5}, {0.25, 1, 0}, {-1, 0.125, 0.5}}}, {7, 4, 5}};
}

std::array<std::uint32_t, 6> extent_of(const std::string& tag, const char* name) {
  std::array<std::uint32_t, 6> extent{};
  std::istringstream in(tests::VtkXmlFile::attribute(tag, name));
  for (std::uint32_t& bound : extent) in >> bound;
  EXPECT_TRUE(in) << tag;
  return extent;
}

// Every place of the grid is in a piece, with the values that belong there; neighbouring pieces share a
// plane.
void expect_values(const Written& all, bool points) {
  std::uint32_t next = 0;
  for (const tests::VtkXmlFile::Piece& piece : all.file.pieces) {
    const auto extent = extent_of(piece.tag, "Extent");
    EXPECT_EQ(extent[0], next);
    EXPECT_EQ((std::array{extent[2], extent[3], extent[4], extent[5]}), (std::array{0U, 3U, 0U, 4U}));
    next = extent[1];
    const auto erosion = piece.arrays.at("E").numbers<double>();
    const auto normal = piece.arrays.at("normal").numbers<double>();
    const auto direction = piece.arrays.at("direction").numbers<std::int32_t>();
    EXPECT_EQ(piece.arrays.at("normal").components, 3);
    EXPECT_EQ(piece.arrays.at("direction").type, "Int32");
    EXPECT_EQ(piece.arrays.at("E").section, "PointData");
    ASSERT_EQ(erosion.size(), std::size_t{extent[1] - extent[0] + 1} * 4 * 5);
    std::size_t at = 0;  // VTK's order
    for (std::uint32_t k = 0; k < 5; ++k) {
      for (std::uint32_t j = 0; j < 4; ++j) {
        for (std::uint32_t i = extent[0]; i <= extent[1]; ++i, ++at) {
          ASSERT_EQ(erosion[at], value_of(0, i, j, k));
          for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(normal[3 * at + c], value_of(1 + c, i, j, k));
          ASSERT_EQ(direction[at], value_of(4, i, j, k));
          if (!points) continue;
          const auto& [origin, axes, dims] = all.grid;
          const auto& stored = piece.arrays.at("Points");
          const bool single = stored.type == "Float32";
          EXPECT_EQ(single, norm(origin) < 100);
          for (int c = 0; c < 3; ++c) {
            const std::size_t n = 3 * at + std::size_t(c);
            ASSERT_NEAR(single ? stored.numbers<float>()[n] : stored.numbers<double>()[n],
                        origin[c] + (i * axes[0][c] + j * axes[1][c] + k * axes[2][c]), single ? 1e-5 : 1e-9);
          }
        }
      }
    }
  }
  EXPECT_EQ(next, 6u) << "the last plane";
}

TEST(VtkXmlGrid, AnImageHoldsEveryValueInItsPlace) {
  for (const std::uint64_t places : {1000, 100, 60, 1}) {  // 1, 2, 3 and 6 pieces
    const Written all = written(false, places, upright());
    expect_values(all, false);
    const std::string tag = all.file.tag("ImageData");
    EXPECT_EQ(extent_of(tag, "WholeExtent"), (std::array{0U, 6U, 0U, 3U, 0U, 4U}));
    EXPECT_EQ(tests::VtkXmlFile::attribute(tag, "Origin"), "0.1 -2 1e+06");
    EXPECT_EQ(tests::VtkXmlFile::attribute(tag, "Spacing"), "0.5 0.25 2");
    EXPECT_EQ(all.file.tag("PointData"), "<PointData Scalars=\"E\">");
  }
  EXPECT_EQ(written(false, 1000, upright()).file.pieces.size(), 1u);
  EXPECT_EQ(written(false, 60, upright()).file.pieces.size(), 3u);
}

TEST(VtkXmlGrid, AStructuredGridHoldsItsPoints) {
  for (const std::uint64_t places : {1000, 60}) {
    const Written all = written(true, places, sheared());
    expect_values(all, true);
    EXPECT_EQ(tests::VtkXmlFile::attribute(all.file.tag("StructuredGrid"), "Origin"), "");
  }
  EXPECT_THROW(written(false, 1000, sheared()), std::logic_error);
}

TEST(VtkXmlGrid, SaysWhatItIs) {
  const Written all = written(false, 1000, upright());
  EXPECT_EQ(all.file.fact("job"), "0123");
  EXPECT_EQ(all.file.fact("content"), "<a> & \"b\"");
  EXPECT_EQ(all.file.facts.at("v0").numbers<double>(), std::vector<double>{2.5});
}

TEST(VtkInlineData, CutsIntoBlocks) {
  // One byte less than two blocks, two blocks, one more.
  for (const std::size_t size :
       {(std::size_t{1} << 18) - 1, std::size_t{1} << 18, (std::size_t{1} << 18) + 1}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * i >> 7);
    const tests::VtkXmlFile file(
        "<VTKFile compressor=\"vtkZLibDataCompressor\"><Piece ><DataArray type=\"UInt8\" Name=\"a\" "
        "format=\"binary\">\n" +
        vtk_inline_compressed(bytes) + "\n</DataArray>");
    EXPECT_EQ(file.pieces.at(0).arrays.at("a").bytes, bytes);
  }
}

}  // namespace
}  // namespace affskel::core
