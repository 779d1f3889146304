// Files of others: the three ways to hold numbers, both byte orders and lengths, pieces, cells of all kinds.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "core/base/error.h"
#include "core/files/base64.h"
#include "core/files/read/parse_shape.h"

namespace affskel::core {
namespace {

using Doubles = std::vector<double>;

template <typename Number>
std::string bytes_of_number(Number value, bool big) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value);
  if (big) raw.assign(raw.rbegin(), raw.rend());
  return raw;
}

// Puts arrays into a file the way that its encoding wants.
struct Encoder {
  std::string format;  // ascii, binary, raw or base64
  bool big = false, long_lengths = false;
  std::string appended = {};

  template <typename Number>
  std::string array(const std::string& attributes, const std::vector<Number>& values) {
    std::string tag = "<DataArray " + attributes + " format=\"";
    if (format == "ascii") {
      for (tag += "ascii\" RangeMin=\"0\">\n "; const Number value : values)
        tag += std::to_string(value) + "\n  ";
      return tag + "</DataArray>\n";
    }
    std::string body;
    for (const Number value : values) body += bytes_of_number(value, big);
    const std::string length = long_lengths ? bytes_of_number(std::uint64_t{body.size()}, big)
                                            : bytes_of_number(static_cast<std::uint32_t>(body.size()), big);
    body = length + body;
    if (format == "binary") return tag + "binary\">\n   " + base64(body) + "\n  </DataArray>\n";
    tag += "appended\" offset=\"" + std::to_string(appended.size()) + "\" />\n";
    appended += format == "raw" ? body : base64(body);
    return tag;
  }

  std::string file(const std::string& pieces) const {
    std::string text =
        "<?xml version='1.0'?>\n<!-- <not> a tag -->\n<VTKFile type=\"PolyData\" version=\"0.1\" "
        "byte_order=\"";
    text += big ? "BigEndian\"" : "LittleEndian\"";
    if (long_lengths) text += " header_type=\"UInt64\"";
    text += ">\n<PolyData>\n" + pieces + "</PolyData>\n";
    if (format == "raw" || format == "base64") {
      text += "<AppendedData encoding=\"" + format + "\">\n   _" + appended + "\n</AppendedData>\n";
    }
    return text + "</VTKFile>\n";
  }
};

std::string piece_of_a_square(Encoder& encoder) {
  return "<Piece NumberOfPoints=\"5\" NumberOfPolys=\"2\">\n<PointData Scalars=\"E\">\n" +
         encoder.array("type=\"Float64\" Name=\"E\"", Doubles{0.5, 1, 2, 3, 4}) +
         encoder.array("type=\"Int16\" Name=\"flag&amp;\"", std::vector<std::int16_t>{-7, 1, 2, 3, 4}) +
         encoder.array("type=\"Float32\" Name=\"normal_a\" NumberOfComponents=\"3\"",
                       std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0}) +
         "<Array type=\"String\" Name=\"words\" format=\"ascii\">0 0 0 0 "
         "0</Array>\n</PointData>\n<CellData/>\n<Points>\n" +
         encoder.array("type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"",
                       std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1.25F, 0, 0, 1, 0, 0.5F, 0.5F, 7}) +
         "</Points>\n<Verts>\n" + encoder.array("type=\"Int32\" Name=\"connectivity\"", std::vector<int>{4}) +
         encoder.array("type=\"Int32\" Name=\"offsets\"", std::vector<int>{1}) + "</Verts>\n<Polys>\n" +
         encoder.array("type=\"Int32\" Name=\"connectivity\"", std::vector<int>{0, 1, 2, 3, 0, 1, 4}) +
         encoder.array("type=\"Int64\" Name=\"offsets\"", std::vector<std::int64_t>{4, 7}) +
         "</Polys>\n</Piece>\n";
}

TEST(VtpParser, NumbersComeInFourWays) {
  for (const char* format : {"ascii", "binary", "raw", "base64"}) {
    for (const bool big : {false, true}) {
      for (const bool long_lengths : {false, true}) {
        Encoder encoder{format, big, long_lengths};
        const std::string pieces = piece_of_a_square(encoder);
        const ShapeFile shape = parse_shape(".vtp", encoder.file(pieces));
        const std::string what = std::string(format) + (big ? " big" : "") + (long_lengths ? " 64" : "");
        ASSERT_EQ(shape.mesh().points.size(), 5u) << what;
        EXPECT_EQ(shape.mesh().points[2], (core::Vec3{1, 1.25, 0})) << what;
        ASSERT_EQ(shape.mesh().triangles.size(), 3u) << what;
        EXPECT_EQ(shape.mesh().triangles[2], (core::Triangle{0, 1, 4})) << what;
        EXPECT_EQ(shape.off.polygons, 2u);
        EXPECT_EQ(shape.off.polygons_cut, 1u);
        ASSERT_EQ(shape.columns.size(), 5u) << what;
        EXPECT_EQ(shape.column("E")->values, (Doubles{0.5, 1, 2, 3, 4})) << what;
        EXPECT_EQ(shape.column("flag&")->values, (Doubles{-7, 1, 2, 3, 4})) << what;
        EXPECT_TRUE(shape.column("flag&")->whole);
        EXPECT_EQ(shape.column("nx_a")->values, (Doubles{0, 0, 0, 0, 1})) << what;
        EXPECT_EQ(shape.column("nz_a")->values, (Doubles{1, 1, 1, 1, 0})) << what;
      }
    }
  }
}

// A piece of so many points (i, 0, 0), each with E = i, as text.
std::string piece_of_points(int count, const std::string& cells, const std::string& array = "E") {
  std::string points, values;
  for (int i = 0; i < count; ++i) {
    points += std::to_string(i) + " " + std::to_string(i * i) + " 0 ";
    values += std::to_string(i) + " ";
  }
  const auto tag = [](const std::string& attributes, const std::string& text) {
    return "<DataArray " + attributes + " format=\"ascii\">" + text + "</DataArray>";
  };
  return "<Piece>\n<Points>" + tag("type=\"Float64\" NumberOfComponents=\"3\"", points) +
         "</Points>\n<PointData>" + tag("type=\"Float64\" Name=\"" + array + "\"", values) +
         "</PointData>\n" + cells + "</Piece>\n";
}

std::string cells(const std::string& section, const std::string& corners, const std::string& ends) {
  return "<" + section + "><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" + corners +
         "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" + ends +
         "</DataArray></" + section + ">\n";
}

ShapeFile parsed(const std::string& pieces) {
  return parse_shape(".vtp", Encoder{"ascii"}.file(pieces));
}

TEST(VtpParser, StripsKeepTheirSide) {
  const ShapeFile shape = parsed(piece_of_points(5, cells("Strips", "0 1 2 3 4", "5")));
  EXPECT_EQ(shape.mesh().triangles, (std::vector<core::Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
}

TEST(VtpParser, StripsAreJoinedByTrianglesWithEqualCorners) {
  // 0 1 2 3 and 4 5 6 turned alike: 3 3 4 4 between them.
  const ShapeFile shape = parsed(piece_of_points(7, cells("Strips", "0 1 2 3 3 4 4 5 6", "9")));
  EXPECT_EQ(shape.mesh().triangles, (std::vector<core::Triangle>{{0, 1, 2}, {2, 1, 3}, {4, 5, 6}}));
  EXPECT_EQ(shape.off.polygons, 3u);
}

TEST(VtpParser, PiecesArePutTogether) {
  const ShapeFile shape = parsed(piece_of_points(3, cells("Polys", "0 1 2", "3")) + piece_of_points(0, "") +
                                 piece_of_points(4, cells("Polys", "1 2 3", "3")));
  EXPECT_EQ(shape.mesh().points.size(), 7u);
  EXPECT_EQ(shape.mesh().triangles, (std::vector<core::Triangle>{{0, 1, 2}, {4, 5, 6}}));
  EXPECT_EQ(shape.column("E")->values, (Doubles{0, 1, 2, 0, 1, 2, 3}));
}

TEST(VtpParser, LinesAreSegmentsAndVerticesArePassedOver) {
  const ShapeFile shape =
      parsed(piece_of_points(3, cells("Lines", "0 1 2", "3") + cells("Verts", "0 1", "1 2")));
  EXPECT_EQ(shape.segments, (std::vector<Segment>{{0, 1}, {1, 2}}));
  EXPECT_EQ(shape.mesh().points.size(), 3u);
}

void expect_bad(const std::string& bytes, std::uint64_t line, const std::string& cause) {
  try {
    parse_shape(".vtp", bytes);
    ADD_FAILURE() << "was read: " << cause;
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kBadInput) << error.what();
    EXPECT_EQ(error.line(), line) << error.what();
    EXPECT_NE(std::string(error.what()).find(cause), std::string::npos) << error.what();
  }
}

void expect_bad_pieces(const std::string& pieces, std::uint64_t line, const std::string& cause) {
  expect_bad(Encoder{"ascii"}.file(pieces), line, cause);  // the first piece begins in line 5
}

TEST(VtpParser, ErrorsNameThePlace) {
  expect_bad("", 1, "not a VTK XML file");
  expect_bad("1 2 3\n", 1, "not a VTK XML file");
  expect_bad("\n<VTKFile type=\"ImageData\">", 2, "only PolyData");
  expect_bad("<VTKFile type=\"PolyData", 1, "does not end");
  expect_bad("<!-- ", 1, "does not end");
  expect_bad("<VTKFile type=PolyData>", 1, "NAME=\"VALUE\"");
  expect_bad("<VTKFile type=\"PolyData\"></VTKFile>", 0, "no <Piece>");
  expect_bad_pieces(piece_of_points(3, cells("Polys", "0 1 3", "3")), 8,
                    "polygon 0 uses a vertex that does not exist");
  expect_bad_pieces(piece_of_points(3, cells("Polys", "0 1 -1", "3")), 8,
                    "polygon 0 uses a vertex that does not exist");
  expect_bad_pieces(piece_of_points(3, cells("Polys", "0 1 2", "4")), 8, "offsets");
  expect_bad_pieces(piece_of_points(3, cells("Polys", "0 1 2", "3 1")), 8, "offsets");
  expect_bad_pieces(piece_of_points(3, cells("Polys", "0 1 1.5", "3")), 8, "not a whole number");
  expect_bad_pieces(piece_of_points(3, cells("Polys", "0 1", "2")), 8, "polygon 0 has 2 corners");
  expect_bad_pieces(piece_of_points(3, "") + piece_of_points(3, "", "F"), 11, "without the values of 'F'");
  expect_bad_pieces(piece_of_points(3, "") +
                        "<Piece><Points><DataArray type=\"Int8\" format=\"ascii\" "
                        "NumberOfComponents=\"3\">1 2 3</DataArray></Points></Piece>",
                    9, "'E'");
  const std::string twice =
      "<PointData><DataArray type=\"Int8\" Name=\"E\" format=\"ascii\">1 2 3</DataArray></PointData>";
  expect_bad_pieces(piece_of_points(3, twice), 8, "two arrays");
  const auto point = [](const std::string& attributes, const std::string& text) {
    return "<Piece>\n<Points><DataArray " + attributes + ">" + text + "</DataArray></Points></Piece>";
  };
  const std::string three = "NumberOfComponents=\"3\" type=\"Float64\" format=\"ascii\"";
  expect_bad_pieces(point(three, "1 2"), 6, "three coordinates");
  expect_bad_pieces(point(three, "1 2 nan"), 6, "not finite");
  expect_bad_pieces(point(three, "1 2 z"), 6, "'z'");
  expect_bad_pieces(point("NumberOfComponents=\"3\" type=\"Float16\" format=\"ascii\"", "1 2 3"), 6,
                    "'Float16'");
  expect_bad_pieces(point("NumberOfComponents=\"3\" type=\"Int8\" format=\"binary\"", "AQ*="), 6,
                    "not base64");
  expect_bad_pieces(point("NumberOfComponents=\"3\" type=\"Int8\" format=\"binary\"", base64("ab")), 6,
                    "length");
  expect_bad_pieces(
      point("NumberOfComponents=\"3\" type=\"Int8\" format=\"binary\"", base64(std::string("\3\0\0\0ab", 6))),
      6, "announces 3 bytes, but only 2 follow");
  expect_bad_pieces(point("NumberOfComponents=\"3\" type=\"Int16\" format=\"binary\"",
                          base64(std::string("\3\0\0\0abc", 7))),
                    6, "half a number");
  expect_bad_pieces(point("NumberOfComponents=\"3\" type=\"Int8\" format=\"appended\" offset=\"9\"", ""), 6,
                    "behind the end");
}

std::string point_data(const std::string& arrays) {
  return "<PointData>" + arrays + "</PointData>\n";
}

TEST(VtpParser, ErrorsNameTheCellWithinItsPiece) {
  const std::string first = piece_of_points(3, cells("Polys", "0 1 2", "3"));  // lines 5 to 9
  const auto bad = [&](const std::string& second, const std::string& cause) {
    expect_bad_pieces(first + piece_of_points(4, second), 13, cause);
  };
  bad(cells("Polys", "0 1 2 0 1 4", "3 6"), "polygon 1 uses a vertex that does not exist");
  bad(cells("Polys", "0 1 2 0 1 2 1", "3 7"), "polygon 1 uses a vertex twice");
  bad(cells("Strips", "0 1 2 0 1 2 4", "3 7"), "strip 1, triangle 1 uses a vertex that does not exist");
  bad(cells("Strips", "0 1 2 4 4 4", "3 6"), "strip 1, triangle 0 uses a vertex that does not exist");
  bad(cells("Strips", "0 1 2 0 1", "3 5"), "strip 1 has 2 corners");
}

TEST(VtpParser, ComponentsOfAllArraysAreBounded) {
  std::string arrays;
  for (int a = 0; a < 4; ++a) {
    arrays += "<DataArray type=\"Int8\" Name=\"a" + std::to_string(a) +
              "\" format=\"ascii\" NumberOfComponents=\"1024\"/>\n";
  }
  const std::string begin = "<Piece>\n", end = "</Piece>\n";
  EXPECT_EQ(parsed(begin + point_data(arrays) + end).columns.size(), 4096u);
  const std::string one = "<DataArray type=\"Int8\" Name=\"b\" format=\"ascii\"/>";
  expect_bad_pieces(begin + point_data(arrays + one) + end, 10, "more than 4096 components in all");
  // Without points there are names alone.
  EXPECT_EQ(parsed(begin + point_data(arrays) + end + begin + point_data(arrays) + end).columns.size(),
            4096u);
  expect_bad_pieces(begin + point_data(one + one) + end, 6, "two arrays");
  for (const char* components : {"0", "4097"}) {
    expect_bad_pieces(begin +
                          point_data("<DataArray type=\"Int8\" Name=\"b\" format=\"ascii\" "
                                     "NumberOfComponents=\"" +
                                     std::string(components) + "\"/>") +
                          end,
                      6, std::string("has ") + components + " components");
  }
}

TEST(VtpParser, ArraysDoNotShareTheirData) {
  constexpr std::size_t kPoints = 1000;
  Encoder encoder{"raw"};
  const std::string points = encoder.array("type=\"Int8\" Name=\"P\" NumberOfComponents=\"3\"",
                                           std::vector<std::int8_t>(3 * kPoints));
  const std::string offset = std::to_string(encoder.appended.size());
  encoder.array("type=\"Int8\" Name=\"a\"", std::vector<std::int8_t>(kPoints));
  const auto file = [&](int arrays) {
    std::string tags;
    for (int a = 0; a < arrays; ++a) {
      tags += "<DataArray type=\"Int8\" Name=\"a" + std::to_string(a) + "\" format=\"appended\" offset=\"" +
              offset + "\"/>\n";
    }
    return encoder.file("<Piece>\n<Points>" + points + "</Points>\n" + point_data(tags) + "</Piece>\n");
  };
  EXPECT_EQ(parse_shape(".vtp", file(1)).columns.size(), 1u);
  // 3000 + 1000 n values are more than its 5000 to 6000 bytes from the third array on.
  expect_bad(file(15), 10, "share");
}

TEST(VtpParser, CommentsDoNotEndTheTextOfAnArray) {
  const std::string begin = "<Piece><Points><DataArray NumberOfComponents=\"3\" type=\"Int8\" format=\"",
                    end = "</DataArray></Points></Piece>";
  const std::string comment = "<!-- 7 < 8 > 9 </DataArray> -->";
  const std::string child = "<InformationKey><Value index=\"0\">7</Value> 8 </InformationKey>";
  for (const std::string& text :
       {"1 2 3 4 " + comment + "5 6", "1 2 " + comment + comment + " 3 4 5 6" + comment,
        child + "1 2 3 4 5 6", "1 2 3 " + child + "4 5" + comment + " 6", "1 2 3 <a/>4 <?b?>5 6" + child}) {
    EXPECT_EQ(parsed(begin + "ascii\">" + text + end).mesh().points,
              (std::vector<core::Vec3>{{1, 2, 3}, {4, 5, 6}}))
        << text;
  }
  const std::string digits = base64(std::string("\3\0\0\0\1\2\3", 7));
  EXPECT_EQ(
      parsed(begin + "binary\">" + digits.substr(0, 5) + comment + digits.substr(5) + end).mesh().points,
      (std::vector<core::Vec3>{{1, 2, 3}}));
}

// Points as text in an array whose element is as given.
std::string points_in(const std::string& text) {
  return "<Piece><Points><DataArray NumberOfComponents=\"3\" type=\"Int8\" format=\"ascii\">" + text +
         "</DataArray></Points></Piece>";
}

TEST(VtpParser, TextMayStandInSectionsAndReferences) {
  for (const char* text :
       {"<![CDATA[1 2 3 4 5 6]]>", "1 2 <![CDATA[3 4]]> 5 <!-- 7 --><![CDATA[6]]>",
        "1 2 &#51; &#x34; 5&#32;6", "1&#10;2\r\n3\r4\n5 6", "<![CDATA[1 2]]>&#x20;3 4<![CDATA[ 5]]> 6 "}) {
    EXPECT_EQ(parsed(points_in(text)).mesh().points, (std::vector<core::Vec3>{{1, 2, 3}, {4, 5, 6}})) << text;
  }
  expect_bad_pieces(points_in("<![CDATA[1 2 <3>]]>"), 5, "'<3>'");
  expect_bad_pieces(points_in("1 2 3<![CDATA["), 7, "does not end");  // where the file does
}

TEST(VtpParser, AttributesMayHoldReferences) {
  const std::string arrays =
      "<DataArray type=\"Int8\" Name=\"a&#38;&#x3c;&quot;&apos;&gt;\" format=\"ascii\">1</DataArray>"
      "<DataArray type=\"Int&#56;\" Name='h&#xE9;' format=\"asc&#105;i\">2</DataArray>";
  const ShapeFile shape = parsed("<Piece><PointData>" + arrays +
                                 "</PointData><Points><DataArray type=\"Int8\" NumberOfComponents=\"&#x33;\" "
                                 "format=\"ascii\">0 0 0</DataArray></Points></Piece>");
  ASSERT_EQ(shape.columns.size(), 2u);
  EXPECT_EQ(shape.columns[0].name, "a&<\"'>");
  EXPECT_EQ(shape.columns[1].name, "h\xC3\xA9");
}

TEST(VtpParser, EntitiesAreRefused) {
  const std::string body =
      "<VTKFile type=\"PolyData\"><PolyData>" + points_in("&b;") + "</PolyData></VTKFile>";
  expect_bad("<?xml version=\"1.0\"?>\n" + body, 2, "undefined entity");
  expect_bad("<?xml version=\"1.0\"?>\n<!DOCTYPE VTKFile>\n" + body, 2, "<!DOCTYPE");
  // Each entity is ten of the one before; a file of the machine's; what would be fetched.
  std::string laughs = "<!DOCTYPE VTKFile [\n<!ENTITY a0 \"1 2 3 \">\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "&a" + std::to_string(i - 1) + ";";
    laughs += "<!ENTITY a" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) laughs += before;
    laughs += "\">\n";
  }
  expect_bad(laughs + "<!ENTITY b \"&a11;\">]>\n" + body, 1, "<!DOCTYPE");
  expect_bad("<!DOCTYPE VTKFile [<!ENTITY b SYSTEM \"file:///etc/passwd\">]>" + body, 1, "<!DOCTYPE");
  expect_bad("\n\n<!DOCTYPE VTKFile SYSTEM \"http://127.0.0.1:1/a.dtd\">" + body, 3, "<!DOCTYPE");
}

TEST(VtpParser, ErrorsOfXmlNameTheLine) {
  const std::string head = "<VTKFile type=\"PolyData\">\n<PolyData>\n";
  expect_bad(head + "<Piece>\n</Points>\n", 4, "mismatched tag");
  expect_bad(head + "<Piece a=\"1\"\n a=\"2\">", 4, "duplicate attribute");
  expect_bad(head + "<Piece>\n\n<Points a>", 5, "NAME=\"VALUE\"");
  expect_bad(head + "<Piece>\n\n\n\x01", 6, "not well-formed");
  expect_bad(head + "<Piece>\n\n\n\n\xFF ", 7, "not well-formed");
  expect_bad(head + "<Piece>\n&#0;", 4, "not well-formed");
}

TEST(VtpParser, WhatXmlTakesIsBounded) {
  const std::string head = "<VTKFile type=\"PolyData\">\n";
  std::string deep = head, names = head, many = head + "<Piece ";
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  expect_bad(deep, 2, "nested more than 100 deep");
  for (int i = 0; i < 5000; ++i) names += "<a" + std::to_string(i) + "/>\n";
  expect_bad(names, 1000, "more than 1000 different names");
  for (int i = 0; i < 20000; ++i) many += "a" + std::to_string(i) + "='' ";
  expect_bad(many + "/>", 2, "more than 1000 different names");
  const std::string megabytes(5 << 20, 'x');
  expect_bad(head + "<!--" + megabytes + "-->", 2, "longer than 1048576 bytes");
  expect_bad(head + "<a b='" + megabytes + "'/>", 2, "longer than 1048576 bytes");
  expect_bad("<!--" + megabytes, 1, "longer than 1048576 bytes");
  // Text is not a tag, and a raw tail no text.
  const std::string blanks(5 << 20, ' ');
  EXPECT_EQ(parsed(points_in("1 2 3" + blanks + "4 5 6")).mesh().points.size(), 2u);
}

TEST(VtpParser, PiecesHoldWhatTheyAnnounce) {
  const std::string all = cells("Verts", "0 1 2", "2 3") + cells("Strips", "0 1 2", "3") +
                          cells("Polys", "0 1 2 2 1 3 0 1 2 3", "3 6 10");
  const auto with = [&](const std::string& attributes) {
    std::string piece = piece_of_points(4, all);
    return piece.insert(std::string("<Piece").size(), attributes);
  };
  const ShapeFile shape =
      parsed(with(" NumberOfPoints=\"4\" NumberOfVerts=\"2\" NumberOfStrips=\"1\" "
                  "NumberOfPolys=\"3\" NumberOfLines=\"0\""));
  EXPECT_EQ(shape.mesh().triangles.size(), 5u);
  expect_bad_pieces(with(" NumberOfPoints=\"7\""), 5, "announces NumberOfPoints 7, but holds 4");
  expect_bad_pieces(with(" NumberOfVerts=\"3\""), 5, "announces NumberOfVerts 3, but holds 2");
  expect_bad_pieces(with(" NumberOfStrips=\"0\""), 5, "announces NumberOfStrips 0, but holds 1");
  expect_bad_pieces(with(" NumberOfPolys=\"4\""), 5, "announces NumberOfPolys 4, but holds 3");
  expect_bad_pieces(with(" NumberOfPolys=\"x\""), 5, "'x'");
  expect_bad_pieces("<Piece NumberOfPoints=\"1\"/>", 5, "announces NumberOfPoints 1, but holds 0");
  for (const char* ends : {"", "3"}) {
    expect_bad_pieces(piece_of_points(4, cells("Polys", "0 1 2 1 2 3", ends)), 8, "6 corners");
  }
}

TEST(VtpParser, FilesCutOffAreRefused) {
  const std::string whole = Encoder{"ascii"}.file(piece_of_points(4, cells("Polys", "0 1 2", "3")));
  for (std::size_t size = 0; size < whole.size() - 1; ++size) {
    EXPECT_THROW(parse_shape(".vtp", whole.substr(0, size)), CoreError) << size;
  }
  EXPECT_EQ(parse_shape(".vtp", whole.substr(0, whole.size() - 1)).mesh().points.size(), 4u);
  expect_bad(whole.substr(0, whole.find("</Piece>")), 8, "without </VTKFile>");
  expect_bad(whole.substr(0, whole.find("<Polys>")) + "<Polys><DataArray>0 1", 8, "does not end");
}

TEST(VtpParser, SaysThatItDoesNotReadCompressedData) {
  Encoder encoder{"raw"};
  std::string file = encoder.file(piece_of_a_square(encoder));
  file.insert(file.find(" version=\"0.1\""), " compressor=\"vtkZLibDataCompressor\"");
  try {
    parse_shape(".vtp", file);
    FAIL();
  } catch (const CoreError& error) {
    EXPECT_NE(std::string(error.what()).find("compressed"), std::string::npos) << error.what();
  }
}

TEST(VtpParser, DamagedFilesAreErrors) {
  for (const char* format : {"ascii", "binary", "raw", "base64"}) {
    Encoder encoder{format, false, true};
    const std::string pieces = piece_of_a_square(encoder), whole = encoder.file(pieces);
    for (std::size_t size = 0; size < whole.size(); size += 7) {
      try {
        parse_shape(".vtp", whole.substr(0, size));
      } catch (const CoreError& error) {
        EXPECT_EQ(error.code(), CoreError::Code::kBadInput) << error.what();
      }
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
      try {
        parse_shape(".vtp", damaged);
      } catch (const CoreError& error) {
        EXPECT_EQ(error.code(), CoreError::Code::kBadInput) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace affskel::core
