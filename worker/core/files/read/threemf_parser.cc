#include <zip.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/affine_map.h"
#include "core/base/error.h"
#include "core/files/read/shape_parsers.h"
#include "core/files/read/unpack.h"
#include "core/files/read/xml_reader.h"
#include "core/text/text_rows.h"

// 3MF (3MF Consortium, core specification 1.3): a zip archive with an XML text of objects, which are meshes or consist
// of others placed by affine maps, and of the items that are built.
namespace affskel::core {
namespace {

constexpr const char* kInstead = "; export its triangles as .ply or .stl";
constexpr std::uint64_t kFewItems = std::uint64_t{1} << 20;  // triangles, vertices and placed objects, ...
constexpr std::uint64_t kMaxCopies = 10;  // ... and above these so many times what the file holds
constexpr int kMaxNesting = 32;           // of components in components
// Extensions that change no triangle, as their namespaces begin; that objects are in other files is told there.
constexpr std::array<std::string_view, 3> kHarmless = {
    "http://schemas.microsoft.com/3dmanufacturing/material/",
    "http://schemas.microsoft.com/3dmanufacturing/production/",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/"};

// The first stands where a file names none.
constexpr std::array<std::string_view, 6> kUnits = {"millimeter", "micron", "centimeter",
                                                    "inch",       "foot",   "meter"};
// Types of objects that help to build or to show the solid, and are no part of it.
constexpr std::array<std::string_view, 3> kBesides = {"support", "solidsupport", "other"};

struct Component {
  std::string object;
  AffineMap map;
  std::uint64_t line = 0;
};

struct Object {
  std::string type;
  Mesh mesh;
  std::vector<Component> components;
};

double number(const XmlElement& element, const char* name) {
  return parse_finite(element.attribute(name), element.line, name);
}

// "m00 m01 m02 m10 ... m32" of row vectors: x' = m00 x + m10 y + m20 z + m30.
AffineMap map_of(const XmlElement& element) {
  const std::string text = element.attribute("transform");
  if (text.empty()) return {};
  TextRows row(text);
  if (!row.next() || row.words().size() != 12) fail_at(element.line, "a transform needs 12 numbers");
  const auto m = [&](std::size_t i) { return parse_finite(row.words()[i], element.line, "transform"); };
  return {{Vec3{m(0), m(3), m(6)}, Vec3{m(1), m(4), m(7)}, Vec3{m(2), m(5), m(8)}}, {m(9), m(10), m(11)}};
}

// Extensions have elements of the same names, such as the vertices of slices: only those of the root's namespace count.
class Model final : public XmlHandler {
 public:
  void declare(std::string_view prefix, std::string_view space) override {
    spaces_[std::string(prefix)] = space;
  }

  Next open(const XmlElement& element) override {
    const std::size_t behind = element.name.find('|') + 1;  // 0 where there is none
    const std::string_view space = element.name.substr(0, behind), name = element.name.substr(behind);
    if (!own_space_) {
      own_space_ = space;
      check_extensions(element);
      read_unit(element.attribute("unit"));
    }
    if (space != *own_space_) return Next::kReadOn;
    if (name == "object") {
      const auto [object, is_new] = objects_.try_emplace(element.attribute("id"));
      if (!is_new) fail_at(element.line, "a second object has the id " + quoted_excerpt(object->first));
      object_ = &object->second;
      object_->type = element.attribute("type");
    } else if (name == "vertex") {
      mesh(element).points.push_back({number(element, "x"), number(element, "y"), number(element, "z")});
    } else if (name == "triangle") {
      mesh(element).triangles.push_back(
          {corner(element, "v1"), corner(element, "v2"), corner(element, "v3")});
    } else if (name == "component" || name == "item") {
      if (is_elsewhere(element))
        fail_at(element.line,
                std::string("has objects in other files of the archive, which are not read") + kInstead);
      Component component{element.attribute("objectid"), map_of(element), element.line};
      (name == "item" ? built_ : held(element).components).push_back(std::move(component));
    }
    return Next::kReadOn;
  }

  ShapeFile take() {
    ShapeFile file;
    file.off.unit = unit_;
    if (built_.empty() && !objects_.empty())
      fail_at(0, std::string("has objects, and none of them is placed: its build is empty") + kInstead);
    for (const auto& [id, object] : objects_)
      held_ += std::max(object.mesh.points.size(), object.mesh.triangles.size());
    for (const Component& item : built_) add(item, AffineMap(), 0, file.off.mesh);
    if (parts_ == 0 && !besides_.empty())
      fail_at(besides_.front().first_line,
              "places only objects of " + besides_.front().word + ", which are no part of a solid");
    file.off.passed_over = std::move(besides_);
    file.off.polygons = file.off.mesh.triangles.size();
    return file;
  }

 private:
  void check_extensions(const XmlElement& element) const {
    const std::string text = element.attribute("requiredextensions");
    TextWords prefixes(text);
    for (std::string_view prefix = prefixes.next(); !prefix.empty(); prefix = prefixes.next()) {
      const auto known = spaces_.find(prefix);
      const std::string space = known == spaces_.end() ? "" : known->second;
      const auto begins = [&](std::string_view start) { return space.starts_with(start); };
      if (!std::any_of(kHarmless.begin(), kHarmless.end(), begins))
        fail_at(element.line, "needs the extension " + quoted_excerpt(prefix) + " (" + space.substr(0, 100) +
                                  "), which is not read" + kInstead);
    }
  }
  void read_unit(const std::string& unit) {
    if (unit.empty()) unit_ = kUnits.front();
    if (std::find(kUnits.begin(), kUnits.end(), unit) != kUnits.end()) unit_ = unit;
  }
  void pass_over(const std::string& type, std::uint64_t line) {
    const std::string word = "type " + type;
    const auto known = std::find_if(besides_.begin(), besides_.end(),
                                    [&](const PassedOver& one) { return one.word == word; });
    if (known != besides_.end()) {
      ++known->rows;
    } else {
      besides_.push_back({word, 1, line, "object"});
    }
  }
  // By an attribute of the extension for production.
  static bool is_elsewhere(const XmlElement& element) {
    for (const char** a = element.attributes; *a != nullptr; a += 2)
      if (std::string_view(a[0]).ends_with("|path") && *a[1] != '\0') return true;
    return false;
  }
  Object& held(const XmlElement& element) {
    if (object_ == nullptr) fail_at(element.line, std::string(element.name) + " outside of an object");
    return *object_;
  }
  Mesh& mesh(const XmlElement& element) { return held(element).mesh; }
  std::uint32_t corner(const XmlElement& element, const char* name) {
    const std::uint64_t vertex = parse_count(element.attribute(name), element.line, name);
    const std::size_t known = mesh(element).points.size();
    if (vertex >= known)
      fail_at(element.line,
              "a triangle uses vertex " + std::to_string(vertex) + " of " + std::to_string(known));
    return static_cast<std::uint32_t>(vertex);
  }

  void add(const Component& component, const AffineMap& outer, int depth, Mesh& whole) {
    const auto found = objects_.find(component.object);
    if (found == objects_.end())
      fail_at(component.line, "there is no object " + quoted_excerpt(component.object));
    if (depth > kMaxNesting)
      fail_at(component.line, "objects lie in each other more than " + std::to_string(kMaxNesting) + " deep");
    const AffineMap map = then(component.map, outer);
    const Mesh& mesh = found->second.mesh;
    placed_ += 1 + std::max(mesh.points.size(), mesh.triangles.size());
    if (placed_ > kFewItems + kMaxCopies * held_)
      throw CoreError(CoreError::Code::kLimit, "is built of more than " + std::to_string(kMaxCopies) +
                                                   " times the triangles that it holds" + kInstead);
    const std::string& type = found->second.type;
    if (std::find(kBesides.begin(), kBesides.end(), type) != kBesides.end()) {
      pass_over(type, component.line);
      return;
    }
    if (found->second.components.empty()) ++parts_;
    const auto first = static_cast<std::uint32_t>(whole.points.size());
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      whole.points.push_back(map(mesh.points[i]));
      if (!is_finite(whole.points.back()))
        fail_at(component.line, "vertex " + std::to_string(i) + " of object " +
                                    quoted_excerpt(component.object) + " is not finite where it is placed");
    }
    const bool mirrored = determinant(map) < 0;
    for (const Triangle& t : mesh.triangles)
      whole.triangles.push_back({first + t[0], first + t[mirrored ? 2 : 1], first + t[mirrored ? 1 : 2]});
    for (const Component& inner : found->second.components) add(inner, map, depth + 1, whole);
  }

  std::map<std::string, std::string, std::less<>> spaces_;  // by prefix
  std::optional<std::string> own_space_;
  std::map<std::string, Object> objects_;
  Object* object_ = nullptr;  // the one that is read
  std::vector<Component> built_;
  std::vector<PassedOver> besides_;
  std::string unit_;
  std::uint64_t placed_ = 0, held_ = 0;
  std::uint64_t parts_ = 0;  // meshes that are placed and not left out
};

// The archive's text of a name; empty when there is none.
std::string entry(zip_t* archive, const char* name, std::uint64_t max_bytes) {
  zip_stat_t told;
  if (zip_stat(archive, name, ZIP_FL_NOCASE, &told) != 0) return "";
  const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(zip_fopen_index(archive, told.index, 0),
                                                                zip_fclose);
  if (file == nullptr) fail_at(0, std::string(name) + " within the archive cannot be read" + kInstead);
  std::string text;
  std::array<char, 1 << 16> piece;
  zip_int64_t got = 0;
  while ((got = zip_fread(file.get(), piece.data(), piece.size())) > 0) {
    text.append(piece.data(), static_cast<std::size_t>(got));
    if (text.size() > max_bytes)
      throw CoreError(CoreError::Code::kLimit, std::string(name) + " within the archive is too long");
  }
  if (got < 0) fail_at(0, std::string(name) + " within the archive is damaged");
  return text;
}

// Where the package says that its model is.
class Relationships final : public XmlHandler {
 public:
  Next open(const XmlElement& element) override {
    if (element.attribute("Type").ends_with("/3dmodel")) model = element.attribute("Target");
    return Next::kReadOn;
  }

  std::string model = "/3D/3dmodel.model";
};

}  // namespace

ShapeFile parse_3mf(std::string_view bytes) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (source == nullptr) throw std::bad_alloc();
  const std::unique_ptr<zip_t, decltype(&zip_discard)> archive(
      zip_open_from_source(source, ZIP_RDONLY, &error), zip_discard);
  if (archive == nullptr) {
    zip_source_free(source);
    fail_at(
        0,
        "begins as an archive (.zip, which .3mf is), and has no directory at its end: it was cut off or changed on "
        "its way; copy or export it again");
  }
  const std::uint64_t max_bytes = max_unpacked(bytes.size());
  Relationships told;
  if (const std::string text = entry(archive.get(), "_rels/.rels", max_bytes); !text.empty())
    read_xml(text, told);
  const std::string name = told.model.substr(std::min(told.model.find_first_not_of('/'), told.model.size()));
  const std::string text = entry(archive.get(), name.c_str(), max_bytes);
  if (text.empty())
    fail_at(0, "is an archive without a 3D model; unpack it, and take the mesh that is in it");
  Model model;
  if (read_xml(text, model, XmlNames::kOfSpaces) != XmlEnd::kComplete)
    fail_at(0, name + " within the archive is cut off");
  return model.take();
}

}  // namespace affskel::core
