// Binary OFF, glTF and 3MF: files of one box, written here by the formats' rules.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/coding.h"
#include "core/base/error.h"
#include "core/files/read/parse_shape.h"
#include "core/shapes/shapes.h"
#include "tools/sample_files.h"

namespace affskel::core {
namespace {

using namespace tests::samples;
using nlohmann::json;

double volume_of(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles)
    six += dot(mesh.points[t[0]], cross(mesh.points[t[1]], mesh.points[t[2]]));
  return six / 6;
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
  // JSON may write a slash, which is a digit of base64, with an escape.
  std::string escaped = gltf(parts);
  for (std::size_t at = escaped.find(";base64,"); (at = escaped.find('/', at)) != std::string::npos; at += 2)
    escaped.insert(at, "\\");
  ASSERT_NE(escaped, gltf(parts));
  expect_box(parse_mesh_file(".gltf", escaped), "gltf");
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
  parts.text["scenes"] = {{{"nodes", nlohmann::json::array()}}};
  EXPECT_NE(refusal(glb(parts)).find("its scene is empty"), std::string::npos) << refusal(glb(parts));
  parts.text.erase("scenes");
  parts.text["nodes"] = nlohmann::json::array();
  EXPECT_NE(refusal(glb(parts)).find("no node has one"), std::string::npos) << refusal(glb(parts));
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

TEST(MeshFormats, GltfMayRequireWhatChangesLooksAlone) {
  GltfParts parts = gltf_parts(box());
  parts.text["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_basisu", "EXT_texture_webp",
                                      "KHR_lights_punctual"};
  expect_box(parse_mesh_file(".glb", glb(parts)), "glb");
  parts.text["extensionsRequired"].push_back("KHR_mesh_quantization");
  EXPECT_NE(refusal(glb(parts)).find("needs KHR_mesh_quantization"), std::string::npos);
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
  EXPECT_NE(refusal("{\"nodes\": [], \"branches\": []}").find("is a curve's graph"), std::string::npos);
  std::string many = "{\"asset\": {}, \"nodes\": [0";
  for (int n = 0; n < 500000; ++n) many += ",0";
  EXPECT_NE(refusal(many + "]}").find("values in its JSON"), std::string::npos);
}

// Nodes that draw one mesh again and again, and primitives that name the same bytes.
TEST(MeshFormats, GltfIsBoundedHoweverItGrows) {
  const GltfParts once = gltf_parts(make_sphere(1, 5000));
  const json node = once.text["nodes"][0], primitive = once.text["meshes"][0]["primitives"][0];
  for (const std::size_t times : {100, 400}) {
    GltfParts nodes = once, primitives = once;
    nodes.text.erase("scenes");  // all nodes are drawn
    nodes.text["nodes"] = std::vector<json>(times, node);
    primitives.text["meshes"][0]["primitives"] = std::vector<json>(times, primitive);
    for (const GltfParts& parts : {nodes, primitives})
      EXPECT_EQ(refusal(glb(parts)).find("draw more than 10 times") != std::string::npos, times == 400)
          << refusal(glb(parts));
  }
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
  EXPECT_NE(
      refusal(
          threemf(
              one,
              "<item objectid=\"1\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" p:path=\"/3D/other.model\"/>"))
          .find("other files"),
      std::string::npos);
  EXPECT_NE(refusal(threemf(one, "")).find("its build is empty"), std::string::npos);
  EXPECT_NE(refusal(archive({{"readme.txt", "none"}})).find("without a 3D model"), std::string::npos);
}

// Slices have vertices, too, and what a model needs is told by prefixes.
TEST(MeshFormats, ThreemfReadsTheElementsOfItsCoreAlone) {
  const std::string one = object_text(box(), "1"), item = "<item objectid=\"1\"/>",
                    space = "http://schemas.microsoft.com/3dmanufacturing/",
                    slices = "<s:slicestack xmlns:s=\"" + space +
                             "slice/2015/07\" id=\"5\"><s:slice><s:vertices><s:vertex x=\"0\" y=\"0\"/>"
                             "</s:vertices></s:slice></s:slicestack>";
  expect_box(parse_mesh_file(".3mf", threemf(slices + one, item)), "3mf");
  expect_box(parse_mesh_file(".3mf", threemf(one + slices, item)), "3mf");
  const auto needs = [&](const std::string& name) {
    return threemf(one, item, "requiredextensions=\"q\" xmlns:q=\"" + name + "\"");
  };
  expect_box(parse_mesh_file(".3mf", needs(space + "material/2015/02")), "3mf");
  EXPECT_NE(refusal(needs("http://example.org/unknown"))
                .find("needs the extension 'q' (http://example.org/unknown)"),
            std::string::npos);
  EXPECT_NE(refusal(threemf(one, item, "requiredextensions=\"p q\"")).find("needs the extension 'p'"),
            std::string::npos);
  EXPECT_NE(refusal(threemf(one + object_text(box(), "1"), item)).find("a second object has the id '1'"),
            std::string::npos);
  EXPECT_NE(
      refusal(threemf("<m:x xmlns:m=\"" + std::string(1025, 'm') + "\"/>" + one, item)).find("namespace"),
      std::string::npos);
}

TEST(MeshFormats, ThreemfTellsItsUnit) {
  const std::string one = object_text(box(), "1"), item = "<item objectid=\"1\"/>";
  EXPECT_EQ(parse_mesh_file(".3mf", threemf(one, item)).off.unit, "millimeter") << "where none is named";
  const MeshFile inches = parse_mesh_file(".3mf", threemf(one, item, "unit=\"inch\""));
  EXPECT_EQ(inches.off.unit, "inch");
  expect_box(inches, "3mf");
  EXPECT_EQ(parse_mesh_file(".3mf", threemf(one, item, "unit=\"ell\"")).off.unit, "");
}

TEST(MeshFormats, ThreemfLeavesOutWhatIsNoPartOfTheSolid) {
  const auto of_type = [](const std::string& id, const std::string& type) {
    const std::string text = object_text(box(), id), model = "type=\"model\"";
    return text.substr(0, text.find(model)) + "type=\"" + type + "\"" +
           text.substr(text.find(model) + model.size());
  };
  const std::string objects =
      of_type("1", "model") + of_type("2", "support") + of_type("3", "solidsupport") + of_type("4", "other") +
      "<object id=\"5\"><components><component objectid=\"1\"/><component objectid=\"2\"/></components></object>";
  const MeshFile built = parse_mesh_file(
      ".3mf",
      threemf(objects,
              "<item objectid=\"2\"/><item objectid=\"3\"/><item objectid=\"4\"/><item objectid=\"5\"/>"));
  expect_box(built, "3mf");
  ASSERT_EQ(built.off.passed_over.size(), 3U);
  EXPECT_EQ(built.off.passed_over[0].word, "type support");
  EXPECT_STREQ(built.off.passed_over[0].each, "object");
  EXPECT_EQ(built.off.passed_over[0].rows, 2U);
  EXPECT_NE(refusal(threemf(objects, "<item objectid=\"2\"/>")).find("only objects of type support"),
            std::string::npos);
  const std::string with_empty = objects + object_text({}, "6"),
                    items = "<item objectid=\"2\"/><item objectid=\"6\"/>";
  EXPECT_EQ(refusal(threemf(with_empty, items)).find("only"), std::string::npos)
      << "a part of the solid, too";
}

TEST(MeshFormats, ThreemfNamesAPlaceThatIsNotFinite) {
  const Mesh far{{{1e300, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
  EXPECT_NE(refusal(threemf(object_text(far, "7"),
                            "<item objectid=\"7\" transform=\"1e10 0 0 0 1 0 0 0 1 0 0 0\"/>"))
                .find("vertex 0 of object '7' is not finite where it is placed"),
            std::string::npos);
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
