#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/coding.h"
#include "core/base/affine_map.h"
#include "core/base/error.h"
#include "core/files/base64.h"
#include "core/files/read/shape_parsers.h"
#include "core/text/text_rows.h"

// glTF 2.0 (Khronos, ISO/IEC 12113): a JSON text with numbers in buffers.  A scene's nodes place meshes by affine
// maps; a mesh has primitives, each with an accessor for its positions and mostly one for its indices.  What is said
// of materials, skins and animations is passed over.
namespace affskel::core {
namespace {

using nlohmann::json;

constexpr std::size_t kMostValues = 400'000;
// Nodes may draw one mesh again and again: triangles and primitives drawn, ...
constexpr std::uint64_t kFewTriangles = std::uint64_t{1} << 20;
constexpr std::uint64_t kMaxDraws = 10;  // ... and above these so many times what the bytes can hold, ...
constexpr std::uint64_t kTriangleBytes = 12;  // ... of which a triangle has three indices of four bytes
constexpr std::string_view kBase64 = ";base64,";
constexpr const char* kAsGlb = "; export it as .glb without compression, or as .ply or .stl";
constexpr int kTriangles = 4, kStrip = 5, kFan = 6;  // modes of primitives; below are points and lines
constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;  // types of components, unsigned

std::string numbered(const char* what, std::size_t i) {
  return std::string(what) + " " + std::to_string(i);
}

// Whether an extension is of looks alone, and changes no coordinate.
bool is_look(std::string_view extension) {
  constexpr std::array<std::string_view, 4> kLooks = {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                                      "KHR_lights_"};
  return std::any_of(kLooks.begin(), kLooks.end(),
                     [&](std::string_view start) { return extension.starts_with(start); });
}

// The JSON with the digits of every base64 text numbered: they are nearly all of the file, and the parser would hold
// them three times.  Digits with an escape among them are left to it.
std::string number_digits(std::string_view text, std::vector<std::string_view>& digits) {
  std::string shorter;
  while (true) {
    const std::size_t found = text.find(kBase64);
    const std::size_t begin = found == std::string_view::npos ? text.size() : found + kBase64.size();
    shorter += text.substr(0, begin);
    text.remove_prefix(begin);
    if (text.empty()) return shorter;
    const std::size_t end = text.find_first_of("\"\\");
    if (end == std::string_view::npos || text[end] != '"') continue;
    shorter += "#" + std::to_string(digits.size());
    digits.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

class Gltf {
 public:
  Gltf(json text, std::vector<std::string_view> digits, std::string_view binary)
      : text_(std::move(text)), digits_(std::move(digits)), binary_(binary) {
    std::uint64_t bytes = binary_.size();
    for (const std::string_view text_of_bytes : digits_) bytes += text_of_bytes.size() / 4 * 3;
    most_ = kFewTriangles + kMaxDraws * (bytes / kTriangleBytes);
  }

  ShapeFile run() {
    for (const json& needed : list(text_, "extensionsRequired")) {
      if (needed.is_string() && !is_look(needed.get_ref<const std::string&>()))
        fail_at(0, "needs " + needed.get<std::string>() + ", which is not read" + kAsGlb);
    }
    drawn_.assign(list(text_, "nodes").size(), false);
    const std::vector<std::size_t> shown = roots();
    if (shown.empty() && !list(text_, "meshes").empty())
      fail_at(0, std::string("has meshes, and none of them is shown: ") +
                     (list(text_, "scenes").empty() ? "no node has one" : "its scene is empty") +
                     "; put them into a scene, and export it again");
    for (const std::size_t root : shown) draw(root, AffineMap());
    ShapeFile file = surface_.take();
    if (others_ > 0) file.off.passed_over.push_back({"points and lines", others_, 0});
    return file;
  }

 private:
  // Where the items of an accessor stand.
  struct View {
    const char* data;
    std::size_t count, stride;
    std::size_t component;
  };

  // A member that is a list; an empty one where there is none.
  static const json& list(const json& object, const char* name) {
    static const json kEmpty = json::array();
    const auto found = object.find(name);
    return found != object.end() && found->is_array() ? *found : kEmpty;
  }
  static std::optional<std::size_t> index(const json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end()) return std::nullopt;
    if (!found->is_number_unsigned()) fail_at(0, std::string("'") + name + "' must be a whole number");
    return found->get<std::size_t>();
  }
  static std::size_t needed(const json& object, const char* name, const std::string& place) {
    const std::optional<std::size_t> found = index(object, name);
    if (!found) fail_at(0, place + " has no '" + name + "'");
    return *found;
  }
  static const json& item(const json& items, std::size_t i, const char* what) {
    if (i >= items.size() || !items[i].is_object()) fail_at(0, "there is no " + numbered(what, i));
    return items[i];
  }
  template <std::size_t kCount>
  static std::array<double, kCount> numbers(const json& object, const char* name,
                                            std::array<double, kCount> usual) {
    const auto found = object.find(name);
    if (found == object.end()) return usual;
    if (!found->is_array() || found->size() != kCount)
      fail_at(0, std::string("'") + name + "' must have " + std::to_string(kCount) + " numbers");
    for (std::size_t i = 0; i < kCount; ++i) {
      if (!(*found)[i].is_number()) fail_at(0, std::string("'") + name + "' holds what is no number");
      usual[i] = (*found)[i].template get<double>();
    }
    return usual;
  }

  // Of the scene that is shown; without scenes all nodes that are no others' children.
  std::vector<std::size_t> roots() const {
    const json& scenes = list(text_, "scenes");
    const json& nodes = list(text_, "nodes");
    std::vector<std::size_t> found;
    if (!scenes.empty()) {
      for (const json& node : list(item(scenes, index(text_, "scene").value_or(0), "scene"), "nodes"))
        if (node.is_number_unsigned()) found.push_back(node.get<std::size_t>());
      return found;
    }
    std::vector<char> child(nodes.size(), 0);
    for (const json& node : nodes)
      for (const json& one : list(node, "children"))
        if (one.is_number_unsigned() && one.get<std::size_t>() < child.size())
          child[one.get<std::size_t>()] = 1;
    for (std::size_t i = 0; i < child.size(); ++i)
      if (child[i] == 0) found.push_back(i);
    return found;
  }

  static AffineMap map_of(const json& node) {
    if (node.contains("matrix")) {
      const auto m =
          numbers<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});  // columns
      return {{Vec3{m[0], m[4], m[8]}, Vec3{m[1], m[5], m[9]}, Vec3{m[2], m[6], m[10]}},
              {m[12], m[13], m[14]}};
    }
    const auto [x, y, z, w] = numbers<4>(node, "rotation", {0, 0, 0, 1});
    const auto scale = numbers<3>(node, "scale", {1, 1, 1});
    const auto shift = numbers<3>(node, "translation", {0, 0, 0});
    const AffineMap turned{{Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            Vec3{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            Vec3{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
    return then(then(scaling(scale[0], scale[1], scale[2]), turned), translation(vector_of(shift)));
  }

  // Nodes form trees: each has one parent, so that none is drawn twice.
  void draw(std::size_t root, const AffineMap& above) {
    std::vector<std::pair<std::size_t, AffineMap>> open{{root, above}};
    while (!open.empty()) {
      const auto [i, outer] = open.back();
      open.pop_back();
      const json& node = item(list(text_, "nodes"), i, "node");
      if (drawn_[i]) fail_at(0, numbered("node", i) + " stands in the tree of nodes twice");
      drawn_[i] = true;
      const AffineMap map = then(map_of(node), outer);
      if (const auto mesh = index(node, "mesh")) draw_mesh(*mesh, map);
      for (const json& child : list(node, "children"))
        if (child.is_number_unsigned()) open.emplace_back(child.get<std::size_t>(), map);
    }
  }

  void draw_mesh(std::size_t i, const AffineMap& map) {
    const json& primitives = list(item(list(text_, "meshes"), i, "mesh"), "primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const std::string place = numbered("mesh", i) + ", " + numbered("primitive", p);
      const json& primitive = item(primitives, p, "primitive");
      const std::size_t mode = index(primitive, "mode").value_or(kTriangles);
      if (mode < kTriangles || mode > kFan) {
        ++others_;
        continue;
      }
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end() || !attributes->is_object()) fail_at(0, place + " has no attributes");
      const View points = positions(needed(*attributes, "POSITION", place), place);
      const std::optional<std::size_t> accessor = index(primitive, "indices");
      const std::optional<View> at = accessor ? std::optional(indices(*accessor, place)) : std::nullopt;
      add(points, at, mode, map, place);
    }
  }

  // Corner by corner as they stand in the file, so that no list of them takes memory beside it.
  void add(const View& points, const std::optional<View>& at, std::size_t mode, const AffineMap& map,
           const std::string& place) {
    const bool mirrored = determinant(map) < 0;
    const std::size_t step = mode == kTriangles ? 3 : 1, count = at ? at->count : points.count;
    drawn_triangles_ += 1 + count / step;
    if (drawn_triangles_ > most_)
      throw CoreError(
          CoreError::Code::kLimit,
          place + ": nodes draw more than " + std::to_string(kMaxDraws) +
              " times the triangles that the file's bytes can hold; export its triangles as .ply or .stl");
    for (std::size_t i = 0; i + 2 < count; i += step) {
      std::size_t a = mode == kFan ? 0 : i, b = i + 1, c = i + 2;
      if (mirrored != (mode == kStrip && i % 2 == 1)) std::swap(b, c);
      for (const std::size_t corner : {a, b, c})
        surface_.add(point(points, at ? vertex(*at, corner, points.count, place) : corner, map, place));
    }
  }

  // The bytes of an accessor whose items have `items` components.
  View view(std::size_t i, const char* type, std::size_t items, const std::string& place) {
    const std::string name = place + ": " + numbered("accessor", i);
    const json& accessor = item(list(text_, "accessors"), i, "accessor");
    if (accessor.contains("sparse")) fail_at(0, name + " is sparse, which is not read" + kAsGlb);
    if (accessor.value("type", json()) != type) fail_at(0, name + " must be of the type " + type);
    const std::size_t component = needed(accessor, "componentType", name);
    const std::size_t size = component == kByte ? 1 : component == kShort ? 2 : 4;
    const std::size_t count = needed(accessor, "count", name);
    const json& part = item(list(text_, "bufferViews"), needed(accessor, "bufferView", name), "bufferView");
    const std::string_view bytes = buffer(needed(part, "buffer", name));
    const std::size_t begin = index(part, "byteOffset").value_or(0),
                      length = needed(part, "byteLength", name);
    const std::size_t first = index(accessor, "byteOffset").value_or(0);
    const std::size_t stride = index(part, "byteStride").value_or(size * items);
    constexpr std::size_t kMax = std::size_t{1} << 40;  // so that no sum below overflows
    if (begin > bytes.size() || length > bytes.size() - begin || first > length || count > kMax ||
        stride > 255 || stride == 0 || (count > 0 && (count - 1) * stride + size * items > length - first))
      fail_at(0, name + " reaches behind its bytes");
    return {bytes.data() + begin + first, count, stride, component};
  }

  View positions(std::size_t accessor, const std::string& place) {
    const View found = view(accessor, "VEC3", 3, place);
    if (found.component != kFloat) fail_at(0, place + ": its positions are no float numbers" + kAsGlb);
    return found;
  }
  static Vec3 point(const View& from, std::size_t i, const AffineMap& map, const std::string& place) {
    const char* at = from.data + i * from.stride;
    const Vec3 point =
        map({base::decode<float>(at), base::decode<float>(at + 4), base::decode<float>(at + 8)});
    if (!is_finite(point)) fail_at(0, place + ", " + numbered("vertex", i) + " is not finite");
    return point;
  }

  View indices(std::size_t accessor, const std::string& place) {
    const View found = view(accessor, "SCALAR", 1, place);
    if (found.component != kByte && found.component != kShort && found.component != kInt)
      fail_at(0, place + ": its indices are no whole numbers");
    return found;
  }
  static std::size_t vertex(const View& from, std::size_t i, std::size_t points, const std::string& place) {
    const char* at = from.data + i * from.stride;
    const std::uint32_t one = from.component == kByte    ? base::decode<std::uint8_t>(at)
                              : from.component == kShort ? base::decode<std::uint16_t>(at)
                                                         : base::decode<std::uint32_t>(at);
    if (one >= points)
      fail_at(0, place + " uses " + numbered("vertex", one) + " of " + std::to_string(points));
    return one;
  }

  std::string_view digits(std::string_view told) const {
    std::size_t number = digits_.size();
    if (told.starts_with('#')) std::from_chars(told.data() + 1, told.data() + told.size(), number);
    return number < digits_.size() ? digits_[number] : told;
  }

  std::string_view buffer(std::size_t i) {
    if (const auto known = decoded_.find(i); known != decoded_.end()) return known->second;
    const json& told = item(list(text_, "buffers"), i, "buffer");
    const auto uri = told.find("uri");
    if (uri == told.end()) {
      if (i > 0 || binary_.empty()) fail_at(0, numbered("buffer", i) + " has no bytes");
      return binary_;
    }
    static const std::string kNowhere;
    const std::string& name = uri->is_string() ? uri->get_ref<const std::string&>() : kNowhere;
    const std::size_t comma = name.find(kBase64);
    if (!name.starts_with("data:") || comma == std::string::npos)
      fail_at(0, "has its numbers in another file, '" + name.substr(0, 60) + "'" + kAsGlb);
    std::optional<std::string> bytes =
        bytes_of_base64(digits(std::string_view(name).substr(comma + kBase64.size())));
    if (!bytes) fail_at(0, numbered("buffer", i) + " is not base64");
    return decoded_.emplace(i, std::move(*bytes)).first->second;
  }

  json text_;
  std::vector<std::string_view> digits_;        // see number_digits
  std::string_view binary_;                     // the binary part of a .glb
  std::map<std::size_t, std::string> decoded_;  // by buffer; views of them stay
  std::vector<bool> drawn_;                     // by node
  std::uint64_t drawn_triangles_ = 0, most_ = 0;
  CornerSurface surface_;
  std::uint64_t others_ = 0;  // primitives of points and lines
};

constexpr std::uint32_t kJsonPart = 0x4E4F534A, kBinaryPart = 0x004E4942;

}  // namespace

ShapeFile parse_gltf(std::string_view bytes) {
  std::string_view text = bytes, binary;
  if (bytes.starts_with("glTF")) {
    if (bytes.size() < 20 || base::decode<std::uint32_t>(bytes.data() + 4) != 2)
      fail_at(0, std::string("is no binary glTF of version 2") + kAsGlb);
    text = {};
    for (std::size_t at = 12; bytes.size() - at >= 8;) {
      const std::size_t size = base::decode<std::uint32_t>(bytes.data() + at);
      const auto kind = base::decode<std::uint32_t>(bytes.data() + at + 4);
      at += 8;
      if (size > bytes.size() - at)
        fail_at(0, "the file ends within a part of " + std::to_string(size) + " bytes");
      if (kind == kJsonPart && text.empty()) text = bytes.substr(at, size);
      if (kind == kBinaryPart && binary.empty()) binary = bytes.substr(at, size);
      at += size;
    }
  }
  // A value takes up to thirty times its bytes.
  std::size_t values = 0;
  const auto counted = [&](int, json::parse_event_t, const json&) {
    if (++values > kMostValues)
      fail_at(0, "has more than " + std::to_string(kMostValues) + " values in its JSON" + kAsGlb);
    return true;
  };
  std::vector<std::string_view> digits;
  json parsed = json::parse(number_digits(text, digits), counted, false);
  if (!parsed.is_object() || !parsed.contains("asset"))
    fail_at(0, parsed.is_object() && parsed.contains("branches")
                   ? "is a curve's graph, no shape: its .vtp and .ply can be compared"
                   : "is no glTF: its JSON has no 'asset'");
  return Gltf(std::move(parsed), std::move(digits), binary).run();
}

}  // namespace affskel::core
