#include "tools/sample_files.h"

#include <zip.h>

#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/files/base64.h"

namespace affskel::tests::samples {

using core::Mesh;
using core::Triangle;
using core::Vec3;
using nlohmann::json;

namespace {

void big_endian(std::string& bytes, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(word >> shift & 255);
}

}  // namespace

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

GltfParts gltf_parts(const Mesh& mesh, std::size_t stride) {
  GltfParts parts;
  for (const Vec3& p : mesh.points) {
    for (const double x : {p.x, p.y, p.z}) base::append(parts.binary, static_cast<float>(x));
    parts.binary.resize(parts.binary.size() + stride - 12, '\x7f');
  }
  const std::size_t positions = parts.binary.size();
  const bool is_short = mesh.points.size() <= 65536;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t corner : t)
      is_short ? base::append(parts.binary, static_cast<std::uint16_t>(corner))
               : base::append(parts.binary, corner);
  parts.text = {
      {"asset", {{"version", "2.0"}}},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", mesh.points.size()}, {"type", "VEC3"}},
        {{"bufferView", 1},
         {"componentType", is_short ? 5123 : 5125},
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
  parts.text["buffers"][0]["uri"] = "data:application/octet-stream;base64," + core::base64(parts.binary);
  return parts.text.dump(1);
}

std::string archive(const std::vector<std::pair<std::string, std::string>>& texts) {
  zip_error_t error;
  zip_source_t* const source = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(source);
  zip_t* const zip = zip_open_from_source(source, ZIP_TRUNCATE, &error);
  for (const auto& [name, text] : texts)
    zip_file_add(zip, name.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0), ZIP_FL_ENC_UTF_8);
  if (zip_close(zip) != 0) throw std::runtime_error("no zip archive can be made");
  zip_source_open(source);
  zip_stat_t told;
  zip_source_stat(source, &told);
  std::string bytes(told.size, '\0');
  zip_source_read(source, bytes.data(), bytes.size());
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

std::string threemf(const std::string& resources, const std::string& items, const std::string& attributes) {
  const std::string model =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" " +
      attributes + "><resources>" + resources + "</resources><build>" + items + "</build></model>";
  const std::string told =
      "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
      "<Relationship Target=\"/3D/body.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  return archive({{"[Content_Types].xml", "<Types/>"}, {"_rels/.rels", told}, {"3D/body.model", model}});
}

std::vector<float> grey_values() {
  std::vector<float> values;
  for (int i = 0; i < 24; ++i) values.push_back(static_cast<float>(i * i - 40));
  return values;
}

std::string nrrd(const std::string& type, const std::string& more, const std::string& data) {
  return "NRRD0005\n# made by hand\ntype: " + type +
         "\ndimension: 3\nsizes: 3 4 2\nspace: left-posterior-superior\n"
         "space directions: (0,2,0) (3,0,0) (0,0,-4)\nspace origin: (10,20,30)\nowner:=someone\n" +
         more + "\n" + data;
}

std::string metaimage(const std::string& type, const std::string& more, const std::string& data) {
  return "ObjectType = Image\nNDims = 3\nDimSize = 3 4 2\nElementSpacing = 2 3 4\nOffset = 10 20 30\n"
         "TransformMatrix = 0 1 0 1 0 0 0 0 -1\nElementType = " +
         type + "\n" + more + "ElementDataFile = LOCAL\n" + data;
}

std::string nifti(bool affine, bool big_endian) {
  std::string bytes(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::string one;
    base::append(one, value);
    if (big_endian) one = std::string(one.rbegin(), one.rend());
    bytes.replace(at, one.size(), one);
  };
  const auto put_all = [&](std::size_t at, const std::vector<float>& values) {
    for (const float value : values) {
      put(at, value);
      at += sizeof value;
    }
  };
  put(0, std::int32_t{348});
  for (const auto& [at, value] :
       std::vector<std::pair<std::size_t, int>>{{40, 3}, {42, 3}, {44, 4}, {46, 2}, {70, 4}})
    put(at, static_cast<std::int16_t>(value));
  put_all(76, {-1, 2, 3, 4});
  put_all(108, {352, 0.5F, 7});
  put(affine ? 254 : 252, std::int16_t{1});
  // A quarter turn about z and, by the sign of the first spacing, a mirror.
  put_all(256, {0, 0, static_cast<float>(std::sqrt(0.5)), 10, 20, 30});
  put_all(280, {0, -3, 0, 10, 2, 0, 0, 20, 0, 0, -4, 30});
  bytes.replace(344, 4, std::string("n+1\0", 4));
  return bytes + bytes_of<std::int16_t>(big_endian);
}

}  // namespace affskel::tests::samples
