// Images of one grid in three formats, written here by the formats' rules.
#include "core/files/read/voxel_parsers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/coding.h"
#include "core/base/error.h"
#include "core/files/read/parse_shape.h"
#include "tools/gzipped.h"
#include "tools/sample_files.h"

namespace affskel::core {
namespace {

using namespace tests::samples;

constexpr std::array<std::size_t, 3> kSize{3, 4, 2};

void expect_image(const VoxelImage& image, double mirrored = 1, double scale = 1, double offset = 0) {
  EXPECT_EQ(image.size, kSize);
  ASSERT_EQ(image.numbers.size(), 24U);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(image.value(i), scale * double{grey_values()[i]} + offset);
  EXPECT_EQ(image.at(1, 2, 1), image.value(1 + 3 * 2 + 12));
  // Two along y, three along x, four against z.
  EXPECT_LT(norm(image.place({1, 2, 1}) - Vec3{10 + mirrored * 6, 22, 26}), 1e-5);
}

TEST(ParseVoxels, OfEveryTypeAndOrder) {
  for (const bool big : {false, true}) {
    const std::string endian = std::string("endian: ") + (big ? "big" : "little") + "\nencoding: raw\n";
    const std::string msb = std::string("BinaryDataByteOrderMSB = ") + (big ? "True" : "False") + "\n";
    expect_image(parse_voxels(nrrd("short", endian, bytes_of<std::int16_t>(big))));
    expect_image(parse_voxels(nrrd("int32_t", endian, bytes_of<std::int32_t>(big))));
    expect_image(parse_voxels(nrrd("float", endian, bytes_of<float>(big))));
    expect_image(parse_voxels(nrrd("double", endian, bytes_of<double>(big))));
    expect_image(parse_voxels(metaimage("MET_SHORT", msb, bytes_of<std::int16_t>(big))));
    expect_image(parse_voxels(metaimage("MET_DOUBLE", msb, bytes_of<double>(big))));
    expect_image(parse_voxels(nifti(true, big)), -1, 0.5, 7);
    expect_image(parse_voxels(nifti(false, big)), -1, 0.5, 7);
  }
}

std::string image_refusal(const std::string& bytes, const ReadBeside& beside = {}) {
  try {
    parse_voxels(bytes, beside);
  } catch (const CoreError& error) {
    return error.what();
  }
  return "";
}

// All names that the formats have for the types that are read.
TEST(ParseVoxels, OfEveryNameOfATypeAndWithWhatSaysNothing) {
  const auto expect_names = [](const std::vector<std::string>& names, const std::string& data) {
    for (const std::string& name : names) expect_image(parse_voxels(nrrd(name, "encoding: raw\n", data)));
  };
  expect_names({"short", "short int", "signed short", "signed short int", "int16", "int16_t"},
               bytes_of<std::int16_t>(false));
  expect_names({"int", "signed int", "int32", "int32_t"}, bytes_of<std::int32_t>(false));
  expect_names({"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
                "int64_t"},
               bytes_of<std::int64_t>(false));
  for (const char* name : {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"})
    EXPECT_EQ(parse_voxels(nrrd(name, "encoding: raw\n", bytes_of<std::uint16_t>(false))).value(23), 489);
  for (const char* name : {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"})
    EXPECT_EQ(parse_voxels(nrrd(name, "encoding: raw\n", bytes_of<std::uint64_t>(false))).value(23), 489);
  const std::string data = bytes_of<std::int32_t>(false);
  expect_image(parse_voxels(nrrd("int", "line skip: 0\nbyte skip: 0\nencoding: raw\n", data)));
  EXPECT_NE(image_refusal(nrrd("int", "byte skip: 4\nencoding: raw\n", data)).find("line 10: skips"),
            std::string::npos);
  expect_image(parse_voxels(metaimage("MET_LONG", "", data)));
}

// Of a header of unknown length, say.
TEST(ParseVoxels, OfNumbersThatAreTheLastBytes) {
  const std::string data = bytes_of<std::int32_t>(false), last = "byte skip: -1\nencoding: raw\n";
  expect_image(parse_voxels(nrrd("int", last, "before them" + data)));
  expect_image(parse_voxels(nrrd("int", "data file: body.raw\n" + last, ""),
                            [&](const std::string&) { return "before them" + data; }));
  EXPECT_NE(image_refusal(nrrd("int", last, data.substr(1))).find("only 95 bytes follow"), std::string::npos);
  EXPECT_NE(image_refusal(nrrd("int", "byte skip: -1\nencoding: text\n", data)).find("skips"),
            std::string::npos);
  EXPECT_NE(image_refusal(nrrd("int", "line skip: -1\nencoding: raw\n", data)).find("skips"),
            std::string::npos);
}

TEST(ParseVoxels, OfAFirstAxisOfOneItem) {
  const std::string data = bytes_of<float>(false),
                    begin = "NRRD0004\ntype: float\ndimension: 4\nsizes: 1 3 4 2\n",
                    end = "encoding: raw\n\n" + data;
  const VoxelImage spaced = parse_voxels(begin + "spacings: nan 2 3 4\n" + end);
  EXPECT_EQ(spaced.size, (std::array<std::size_t, 3>{3, 4, 2}));
  EXPECT_EQ(spaced.place({1, 1, 1}), (Vec3{2, 3, 4}));
  const VoxelImage turned = parse_voxels(begin + "space directions: none (0,2,0) (3,0,0) (0,0,4)\n" + end);
  EXPECT_EQ(turned.place({1, 0, 0}), (Vec3{0, 2, 0}));
}

// Where an image has directions, the axis without one is that of the values at a place, wherever it stands.
TEST(ParseVoxels, TheAxisWithoutADirectionIsOfOneItem) {
  const std::string data = bytes_of<float>(false).substr(0, 12 * sizeof(float));
  const auto image = [&](const std::string& sizes, const std::string& directions) {
    return "NRRD0004\ntype: float\ndimension: 4\nsizes: " + sizes + "\nspace directions: " + directions +
           "\nencoding: raw\n\n" + data;
  };
  const std::string three = "(0,2,0) (3,0,0) (0,0,4)";
  for (const auto& [sizes, directions] : {std::pair("1 3 4 1", "none " + three),
                                          {"3 4 1 1", three + " none"},
                                          {"3 4 1 1", "(0,2,0) (3,0,0) none (0,0,4)"}}) {
    const VoxelImage read = parse_voxels(image(sizes, directions));
    EXPECT_EQ(read.size, (std::array<std::size_t, 3>{3, 4, 1})) << sizes;
    EXPECT_EQ(read.place({1, 0, 0}), (Vec3{0, 2, 0})) << directions;
  }
  EXPECT_NE(image_refusal(image("3 4 1 1", "none " + three)).find("more than one value at a place"),
            std::string::npos);
  EXPECT_NE(image_refusal(image("3 4 1 1", three)).find("for each of the 4 axes"), std::string::npos);
  EXPECT_NE(image_refusal(image("3 4 1 1", "none none (0,2,0) (3,0,0)")), "");
  EXPECT_NE(image_refusal(image("3 4 1 1", three + " none 1")), "");
  EXPECT_NE(image_refusal(image("none 3 4 1", three)), "");
  EXPECT_NE(image_refusal("ObjectType = Image\nNDims = 3\nDimSize = none 3 4 1\nElementType = MET_FLOAT\n"
                          "ElementDataFile = LOCAL\n" +
                          data),
            "");
}

// A fourth axis of one item has a size, a spacing, which may be no number, and a row and a column of the matrix.
TEST(ParseVoxels, OfAFourthAxisOfOneItem) {
  const std::string data = bytes_of<float>(false);
  const VoxelImage spaced = parse_voxels(
      "NRRD0004\ntype: float\ndimension: 4\nsizes: 3 4 2 1\nspacings: 2 3 4 nan\nencoding: raw\n\n" + data);
  EXPECT_EQ(spaced.place({1, 1, 1}), (Vec3{2, 3, 4}));
  EXPECT_NE(
      image_refusal(
          "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 4 2\nspacings: 2 nan 4\nencoding: raw\n\n" + data),
      "");
  const std::string meta =
      "ObjectType = Image\nNDims = 4\nDimSize = 3 4 2 1\nElementSpacing = 2 3 4 1\nOffset = 10 20 30 0\n"
      "TransformMatrix = 0 1 0 0 1 0 0 0 0 0 -1 0 0 0 0 1\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n";
  expect_image(parse_voxels(meta + data));
  std::string fewer = meta;
  fewer.replace(fewer.find(" 1\nOffset"), 2, " 1 1");
  EXPECT_NE(image_refusal(fewer + data).find("needs 4 numbers"), std::string::npos);
}

TEST(ParseVoxels, PackedAndAsText) {
  const std::string data = bytes_of<float>(false);
  expect_image(parse_voxels(nrrd("float", "encoding: gzip\n", tests::gzipped(data))));
  std::string text;
  for (const float value : grey_values()) text += std::to_string(value) + "\n";
  expect_image(parse_voxels(nrrd("float", "encoding: ascii\n", text)));
  expect_image(parse_voxels(metaimage("MET_FLOAT", "CompressedData = True\n", tests::gzipped(data))));
}

// A header that ends as the file does, and the numbers in another one.
std::string mhd(const std::string& file, const std::string& more = "") {
  std::string header = metaimage("MET_FLOAT", more, "");
  return header.replace(header.find("LOCAL"), std::string::npos, file);
}
std::string nhdr(const std::string& file, const std::string& encoding) {
  const std::string header = nrrd("float", "encoding: " + encoding + "\ndata file: " + file, "");
  return header.substr(0, header.size() - 1);
}

TEST(ParseVoxels, WithNumbersInAFileBesideTheHeader) {
  const std::string data = bytes_of<float>(false);
  std::string asked, given = data;
  const ReadBeside beside = [&](const std::string& name) {
    asked = name;
    return given;
  };
  expect_image(parse_voxels(mhd("a body.raw"), beside));
  EXPECT_EQ(asked, "a body.raw");
  expect_image(parse_voxels(nhdr("body.raw", "raw"), beside));
  EXPECT_EQ(asked, "body.raw");
  given = tests::gzipped(data);
  expect_image(parse_voxels(mhd("body.zraw", "CompressedData = True\n"), beside));
  expect_image(parse_voxels(nhdr("body.raw.gz", "gzip"), beside));
  EXPECT_NE(image_refusal(nhdr("body.txt", "text"), beside).find("as text"), std::string::npos);
  given = data.substr(4);
  EXPECT_NE(image_refusal(mhd("body.raw"), beside).find("24 voxels announced, but only 92 bytes"),
            std::string::npos);
}

TEST(ParseVoxels, AHeaderDoesNotChooseWhatIsRead) {
  std::string asked;
  const ReadBeside beside = [&](const std::string& name) {
    asked = name;
    return bytes_of<float>(false);
  };
  for (const char* name : {"/etc/passwd", "../body.raw", "scans/body.raw", "..\\body.raw", "..", "."}) {
    EXPECT_NE(image_refusal(mhd(name), beside).find("not in the same folder"), std::string::npos) << name;
    EXPECT_NE(image_refusal(nhdr(name, "raw"), beside).find("not in the same folder"), std::string::npos);
  }
  for (const char* name : {"LIST", "body%03d.raw 1 10 1"})
    EXPECT_NE(image_refusal(mhd(name), beside).find("several files"), std::string::npos) << name;
  EXPECT_NE(image_refusal(mhd("body.raw", "HeaderSize = 8\n"), beside).find("skips bytes"),
            std::string::npos);
  EXPECT_EQ(asked, "");
  EXPECT_NE(image_refusal(mhd("body.raw")).find("another file"), std::string::npos);
}

// What is skipped or written as text would be taken for the numbers' bytes.
TEST(ParseVoxels, AMetaImageOfTextOrWithBytesBeforeItsNumbersIsRefused) {
  const std::string data = bytes_of<float>(false);
  EXPECT_NE(image_refusal(metaimage("MET_UCHAR", "BinaryData = False\n", std::string(48, '1')))
                .find("line 8: has its numbers as text"),
            std::string::npos);
  EXPECT_NE(image_refusal(metaimage("MET_FLOAT", "HeaderSize = 12\n", data)).find("skips bytes"),
            std::string::npos);
  for (const char* is_binary : {"True", "true", "1", ""})
    expect_image(parse_voxels(
        metaimage("MET_FLOAT", std::string("HeaderSize = 0\nBinaryData = ") + is_binary + "\n", data)));
  expect_image(parse_voxels(metaimage("MET_FLOAT", "BinaryDataByteOrderMSB = T\n", bytes_of<float>(true))));
}

TEST(ParseVoxels, SaysWhatIsWrong) {
  const std::string raw = "encoding: raw\n", data = bytes_of<float>(false);
  EXPECT_NE(image_refusal(nrrd("float", raw, data.substr(1))).find("24 voxels announced, but only"),
            std::string::npos);
  EXPECT_NE(image_refusal(nrrd("colour", raw, data)).find("unknown type of values 'colour'"),
            std::string::npos);
  EXPECT_NE(image_refusal(nrrd("float", "data file: body.raw\n", data)).find("another file"),
            std::string::npos);
  EXPECT_NE(image_refusal(nrrd("float", "encoding: bzip2\n", data)).find("line 10"), std::string::npos);
  EXPECT_NE(image_refusal(nrrd("float", "sizes: 3 4\n" + raw, data)).find("has 2 axes"), std::string::npos);
  EXPECT_NE(image_refusal(nrrd("float", "sizes: 3 4 2 2\n" + raw, data)).find("more than one value"),
            std::string::npos);
  EXPECT_NE(image_refusal(nrrd("float", "sizes: 30000 30000 30000\n" + raw, data)).find("more than"),
            std::string::npos);
  EXPECT_NE(image_refusal(nrrd("float", raw, std::string(96, '\xff'))).find("not finite"), std::string::npos);
  EXPECT_NE(image_refusal(nrrd("float", "space directions: (1,0,0) (2,0,0) (0,0,1)\n" + raw, data)), "");
  EXPECT_NE(
      image_refusal("ObjectType = Image\nDimSize = 3 4 2\nElementType = MET_FLOAT\nElementDataFile = a.raw\n")
          .find("another file"),
      std::string::npos);
  std::string pair = nifti(true, false);
  pair[345] = 'i';
  EXPECT_NE(image_refusal(pair), "");
}

// Cut off anywhere, and with any byte another, a file is read or refused.
TEST(ParseVoxels, DamagedFilesAreReadOrRefused) {
  for (const std::string& bytes :
       {nrrd("short", "encoding: raw\n", bytes_of<std::int16_t>(false)),
        metaimage("MET_SHORT", "", bytes_of<std::int16_t>(false)), nifti(true, true)}) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      if (is_voxel_image(bytes.substr(0, size))) {
        EXPECT_NE(image_refusal(bytes.substr(0, size)), "") << size;
      }
    }
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      for (const int flip : {1, 4, 0x80, 0xff}) {
        std::string other = bytes;
        other[at] = static_cast<char>(other[at] ^ flip);
        if (is_voxel_image(other)) image_refusal(other);
      }
    }
  }
}

TEST(ParseVoxels, AMeshNeedsTheValueAtItsSurface) {
  const std::string bytes = nrrd("float", "encoding: raw\n", bytes_of<float>(false));
  try {
    parse_mesh_file(".nrrd", bytes);
    ADD_FAILURE();
  } catch (const CoreError& error) {
    EXPECT_NE(std::string(error.what()).find("3 x 4 x 2 voxels with values from -40 to 489"),
              std::string::npos)
        << error.what();
  }
  const MeshFile file = parse_mesh_file("", bytes, {100});
  EXPECT_EQ(file.format, "voxels");
  EXPECT_GT(file.off.mesh.triangles.size(), 10U);
  EXPECT_NE(file.told.find("24 voxels"), std::string::npos);
  EXPECT_NE(file.told.find("reaches the image's border"), std::string::npos);
  EXPECT_THROW(parse_mesh_file(".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {100}), CoreError)
      << "a mesh has no such value";
}

}  // namespace
}  // namespace affskel::core
