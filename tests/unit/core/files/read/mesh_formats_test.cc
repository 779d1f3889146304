// Binary OFF, glTF and 3MF: files of one box, written here by the formats' rules.
#include <gtest/gtest.h>
#include <zip.h>

#include <bit>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/coding.h"
#include "core/base/error.h"
#include "core/files/base64.h"
#include "core/files/read/parse_shape.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

using nlohmann::json;

double volume_of(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles)
    six += dot(mesh.points[t[0]], cross(mesh.points[t[1]], mesh.points[t[2]]));
  return six / 6;
}

void big_endian(std::string& bytes, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(word >> shift & 255);
}

std::string binary_off(const Mesh& mesh, const std::string& header, unsigned more) {
  std::string bytes = header + " BINARY\n";
  for (const std::size_t count : {mesh.points.size(), mesh.triangles.size(), std::size_t{0}})
    big_endian(bytes, static_cast<std::uint32_t>(count));
  for (const Vec3& p : mesh.points) {
    for (const double x : {p.x, p.y, p.z})
      big_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    for (unsigned i = 0; i < more; ++i) big_endian(bytes, std::bit_cast<std::uint32_t>(0.5F));
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t word : {3U, t[0], t[1], t[2], 1U, 0U}) big_endian(bytes, word);
  }
  return bytes;
}

// Positions and indices of a mesh as glTF has them, each in a view of its own.
struct GltfParts {
  json text;
  std::string binary;
};

GltfParts gltf_parts(const Mesh& mesh, std::size_t stride = 12) {
  GltfParts parts;
  for (const Vec3& p : mesh.points) {
    for (const double x : {p.x, p.y, p.z}) base::append(parts.binary, static_cast<float>(x));
    parts.binary.resize(parts.binary.size() + stride - 12, '\x7f');
  }
  const std::size_t positions = parts.binary.size();
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t corner : t) base::append(parts.binary, static_cast<std::uint16_t>(corner));
  parts.text = {
      {"asset", {{"version", "2.0"}}},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", mesh.points.size()}, {"type", "VEC3"}},
        {{"bufferView", 1},
         {"componentType", 5123},
         {"count", 3 * mesh.triangles.size()},
         {"type", "SCALAR"}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteLength", positions}, {"byteStride", stride}},
        {{"buffer", 0}, {"byteOffset", positions}, {"byteLength", parts.binary.size() - positions}}}},
      {"buffers", {{{"byteLength", parts.binary.size()}}}}};
  return parts;
}

std::string glb(const GltfParts& parts) {
  std::string text = parts.text.dump(), binary = parts.binary;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  const auto word = [&](std::size_t value) { base::append(bytes, static_cast<std::uint32_t>(value)); };
  word(2);
  word(28 + text.size() + binary.size());
  word(text.size());
  word(0x4E4F534A);
  bytes += text;
  word(binary.size());
  word(0x004E4942);
  return bytes + binary;
}

std::string gltf(GltfParts parts) {
  parts.text["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(parts.binary);
  return parts.text.dump(1);
}

// A zip archive of texts.
std::string archive(const std::vector<std::pair<std::string, std::string>>& texts) {
  zip_error_t error;
  zip_source_t* const source = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(source);
  zip_t* const zip = zip_open_from_source(source, ZIP_TRUNCATE, &error);
  for (const auto& [name, text] : texts)
    zip_file_add(zip, name.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0), ZIP_FL_ENC_UTF_8);
  EXPECT_EQ(zip_close(zip), 0);
  zip_source_open(source);
  zip_stat_t told;
  zip_source_stat(source, &told);
  std::string bytes(told.size, '\0');
  EXPECT_EQ(zip_source_read(source, bytes.data(), bytes.size()), static_cast<zip_int64_t>(bytes.size()));
  zip_source_close(source);
  zip_source_free(source);
  return bytes;
}

std::string object_text(const Mesh& mesh, const std::string& id) {
  std::string text = "<object id=\"" + id + "\" type=\"model\"><mesh><vertices>\n";
  for (const Vec3& p : mesh.points)
    text += "<vertex x=\"" + std::to_string(p.x) + "\" y=\"" + std::to_string(p.y) + "\" z=\"" +
            std::to_string(p.z) + "\"/>\n";
  text += "</vertices><triangles>\n";
  for (const Triangle& t : mesh.triangles)
    text += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
            std::to_string(t[2]) + "\"/>\n";
  return text + "</triangles></mesh></object>";
}

std::string threemf(const std::string& resources, const std::string& items) {
  const std::string model =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>" +
      resources + "</resources><build>" + items + "</build></model>";
  const std::string told =
      "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
      "<Relationship Target=\"/3D/body.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  return archive({{"[Content_Types].xml", "<Types/>"}, {"_rels/.rels", told}, {"3D/body.model", model}});
}

const Mesh& box() {
  static const Mesh mesh = make_box(2, 3, 5);
  return mesh;
}

std::string refusal(std::string_view bytes) {
  try {
    parse_mesh_file("", bytes);
  } catch (const CoreError& error) {
    return error.what();
  }
  return "";
}

void expect_box(const MeshFile& file, const std::string& format, double volume = 30) {
  EXPECT_EQ(file.format, format);
  EXPECT_FALSE(file.off_text);
  EXPECT_EQ(file.off.mesh.points.size(), box().points.size());
  EXPECT_EQ(file.off.mesh.triangles.size(), box().triangles.size());
  EXPECT_NEAR(volume_of(file.off.mesh), volume, 1e-5 * volume);
}

TEST(MeshFormats, BinaryOff) {
  expect_box(parse_mesh_file(".off", binary_off(box(), "OFF", 0)), "binary off");
  expect_box(parse_mesh_file(".stl", binary_off(box(), "CNOFF", 7)), "binary off");
  expect_box(parse_mesh_file("", binary_off(box(), "STOFF", 2)), "binary off");
  std::string many = binary_off(box(), "OFF", 0);
  many[11] = '\x7f';  // the first byte of the vertex count
  EXPECT_NE(refusal(many).find("announced, but only"), std::string::npos) << refusal(many);
}

TEST(MeshFormats, GltfPlacesMeshesByItsNodes) {
  GltfParts parts = gltf_parts(box(), 20);
  expect_box(parse_mesh_file(".glb", glb(parts)), "glb");
  expect_box(parse_mesh_file(".gltf", gltf(parts)), "gltf");
  // A quarter turn about z, twice as large, moved; the same as a matrix, of columns; the same in two nodes.
  const double half = std::sqrt(0.5);
  const std::vector<json> same = {
      {{{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"scale", {2, 2, 2}}, {"translation", {7, 8, 9}}}},
      {{{"mesh", 0}, {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 7, 8, 9, 1}}}},
      {{{"children", {1}}, {"translation", {7, 8, 9}}},
       {{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"scale", {2, 2, 2}}}}};
  for (const json& nodes : same) {
    parts.text["nodes"] = nodes;
    const MeshFile file = parse_mesh_file("", glb(parts));
    expect_box(file, "glb", 240);
    for (std::size_t i = 0; i < box().points.size(); ++i) {
      const Vec3 p = box().points[i], wanted{7 - 2 * p.y, 8 + 2 * p.x, 9 + 2 * p.z};
      bool there = false;
      for (const Vec3& q : file.off.mesh.points) there |= norm(q - wanted) < 1e-5;
      EXPECT_TRUE(there) << nodes;
    }
  }
  // A mirror leaves the outside outside; without scenes all roots are drawn.
  parts.text["nodes"] = {{{"mesh", 0}, {"scale", {-1, 1, 1}}}};
  parts.text.erase("scenes");
  expect_box(parse_mesh_file("", glb(parts)), "glb");
}

TEST(MeshFormats, GltfHasStripsFansAndPlainCorners) {
  // A tetrahedron as a strip, and as a fan without its base, which is an extra primitive.
  const Mesh corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
  GltfParts parts = gltf_parts(corners);
  const auto primitive = [&](const std::vector<unsigned char>& indices, int mode) {
    parts.text["accessors"].push_back({{"bufferView", parts.text["bufferViews"].size()},
                                       {"componentType", 5121},
                                       {"count", indices.size()},
                                       {"type", "SCALAR"}});
    parts.text["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", parts.binary.size()}, {"byteLength", indices.size()}});
    parts.binary.append(indices.begin(), indices.end());
    return json{
        {"attributes", {{"POSITION", 0}}}, {"indices", parts.text["accessors"].size() - 1}, {"mode", mode}};
  };
  parts.text["meshes"][0]["primitives"] = json::array({primitive({0, 2, 1, 3, 0, 2}, 5)});
  MeshFile file = parse_mesh_file("", glb(parts));
  EXPECT_EQ(file.off.mesh.triangles.size(), 4U);
  EXPECT_NEAR(volume_of(file.off.mesh), 1.0 / 6, 1e-6);
  parts.text["meshes"][0]["primitives"] =
      json::array({primitive({3, 0, 1, 2, 0}, 6), primitive({0, 2, 1}, 4), primitive({0, 1}, 1)});
  file = parse_mesh_file("", glb(parts));
  EXPECT_EQ(file.off.mesh.triangles.size(), 4U);
  EXPECT_NEAR(volume_of(file.off.mesh), 1.0 / 6, 1e-6);
  ASSERT_EQ(file.off.passed_over.size(), 1U);
  EXPECT_EQ(file.off.passed_over[0].rows, 1U);
  // Without indices every three vertices are a triangle.
  Mesh soup;
  for (const Triangle& t : box().triangles)
    for (const std::uint32_t corner : t) soup.points.push_back(box().points[corner]);
  GltfParts plain = gltf_parts(soup);
  plain.text["meshes"][0]["primitives"][0].erase("indices");
  expect_box(parse_mesh_file("", glb(plain)), "glb");
}

TEST(MeshFormats, GltfSaysWhatItCannotRead) {
  const auto without = [](const std::function<void(json&)>& change) {
    GltfParts parts = gltf_parts(box());
    change(parts.text);
    return refusal(glb(parts));
  };
  EXPECT_NE(without([](json& t) {
              t["extensionsRequired"] = {"KHR_draco_mesh_compression"};
            }).find("needs KHR_draco"),
            std::string::npos);
  EXPECT_NE(without([](json& t) { t["buffers"][0]["uri"] = "body.bin"; }).find("another file, 'body.bin'"),
            std::string::npos);
  EXPECT_NE(without([](json& t) { t["accessors"][0]["sparse"] = json::object(); }).find("sparse"),
            std::string::npos);
  EXPECT_NE(without([](json& t) { t["accessors"][0]["count"] = 9; }).find("reaches behind"),
            std::string::npos);
  EXPECT_NE(without([](json& t) { t["accessors"][0]["count"] = ~std::uint64_t{0}; }).find("reaches behind"),
            std::string::npos);
  EXPECT_NE(without([](json& t) { t["accessors"][0]["count"] = 7; }).find("vertex 7 of 7"),
            std::string::npos);
  EXPECT_NE(without([](json& t) { t["nodes"][0]["children"] = {0}; }).find("twice"), std::string::npos);
  EXPECT_NE(refusal("{\"nodes\": []}").find("no glTF"), std::string::npos);
}

TEST(MeshFormats, ThreemfPlacesObjectsInObjects) {
  const std::string one = object_text(box(), "1");
  expect_box(parse_mesh_file(".3mf", threemf(one, "<item objectid=\"1\"/>")), "3mf");
  // Row vectors: the last three numbers move.
  const MeshFile moved = parse_mesh_file(
      "",
      threemf(
          one +
              "<object id=\"2\"><components><component objectid=\"1\" transform=\"0 2 0 -2 0 0 0 0 2 0 0 0\"/>"
              "</components></object>",
          "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 -1 7 8 9\"/>"));
  expect_box(moved, "3mf", 240);
  for (std::size_t i = 0; i < box().points.size(); ++i) {
    const Vec3 p = box().points[i], q = moved.off.mesh.points[i];
    EXPECT_LT(norm(q - Vec3{7 - 2 * p.y, 8 + 2 * p.x, 9 - 2 * p.z}), 1e-9);
  }
  EXPECT_NE(refusal(threemf(one, "<item objectid=\"3\"/>")).find("no object '3'"), std::string::npos);
  EXPECT_NE(refusal(threemf("<object id=\"2\"><components><component objectid=\"2\"/></components></object>",
                            "<item objectid=\"2\"/>"))
                .find("deep"),
            std::string::npos);
  EXPECT_NE(refusal(threemf(one, "<item objectid=\"1\" p:path=\"/3D/other.model\"/>")).find("other files"),
            std::string::npos);
  EXPECT_NE(refusal(archive({{"readme.txt", "none"}})).find("without a 3D model"), std::string::npos);
}

// Objects that place objects that place objects: a few lines that stand for 10^30 boxes.
TEST(MeshFormats, ThreemfIsBoundedHoweverItGrows) {
  std::string objects = object_text(box(), "0");
  for (int level = 1; level <= 30; ++level) {
    const std::string inner = "<component objectid=\"" + std::to_string(level - 1) + "\"/>";
    objects += "<object id=\"" + std::to_string(level) + "\"><components>";
    for (int i = 0; i < 10; ++i) objects += inner;
    objects += "</components></object>";
  }
  EXPECT_NE(refusal(threemf(objects, "<item objectid=\"30\"/>")).find("more than 10 times"),
            std::string::npos);
}

// Cut off anywhere, and with any byte another, a file is read or refused.
TEST(MeshFormats, DamagedFilesAreReadOrRefused) {
  const std::vector<std::string> files = {binary_off(box(), "COFF", 4), glb(gltf_parts(box())),
                                          gltf(gltf_parts(box())),
                                          threemf(object_text(box(), "1"), "<item objectid=\"1\"/>")};
  for (const std::string& bytes : files) {
    std::size_t refused = 0;
    for (std::size_t size = 0; size < bytes.size(); ++size)
      refused += refusal(bytes.substr(0, size)).empty() ? 0 : 1;
    EXPECT_GT(refused, bytes.size() - 8) << bytes.substr(0, 8);  // what pads may be missing
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      for (const int flip : {1, 0x80, 0xff}) {
        std::string other = bytes;
        other[at] = static_cast<char>(other[at] ^ flip);
        refusal(other);
      }
    }
  }
}

}  // namespace
}  // namespace affskel::core
