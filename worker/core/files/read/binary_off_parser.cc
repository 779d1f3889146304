#include <bit>
#include <string>

#include "base/packed_numbers.h"
#include "core/files/read/shape_parsers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

// Geomview's binary form (oogl, OFF): behind the line of the header 32-bit numbers, most significant byte first.
// Counts of vertices, faces, edges; per vertex its coordinates and what the header promises; per face its size,
// indices, and a number of components of colour with these.
class BinaryOff {
 public:
  explicit BinaryOff(std::string_view bytes) {
    const std::size_t end = bytes.find('\n');
    const std::string_view header = bytes.substr(0, bytes.find("OFF"));
    rest_ = end == std::string_view::npos ? std::string_view{} : bytes.substr(end + 1);
    if (header.find_first_of("4n") != std::string_view::npos)
      fail_at(0, "binary points of other than three coordinates are not read; write the mesh as text");
    more_ = (header.find('N') != std::string_view::npos ? 3U : 0U) +
            (header.find('C') != std::string_view::npos ? 4U : 0U) +
            (header.find("ST") != std::string_view::npos ? 2U : 0U);
  }

  ShapeFile run() {
    const std::uint32_t vertices = count("the vertex count"), faces = count("the face count");
    count("the edge count");
    if (std::uint64_t{vertices} * 4 * (3 + more_) + std::uint64_t{faces} * 8 > rest_.size()) {
      fail_at(0, std::to_string(vertices) + " vertices and " + std::to_string(faces) +
                     " faces announced, but only " + std::to_string(rest_.size()) + " bytes follow");
    }
    for (std::uint32_t v = 0; v < vertices; ++v) read_vertex(v);
    for (std::uint32_t f = 0; f < faces; ++f) read_face(f);
    if (!rest_.empty()) fail_at(0, std::to_string(rest_.size()) + " bytes behind the last face");
    file_.off.polygons = faces;
    return std::move(file_);
  }

 private:
  std::uint32_t word(const std::string& place) {
    if (rest_.size() < 4) fail_at(0, "the file ends at " + place);
    const auto bits = base::decode_ordered<std::uint32_t>(rest_.data(), true);
    rest_.remove_prefix(4);
    return bits;
  }
  std::uint32_t count(const std::string& what) {
    const auto value = std::bit_cast<std::int32_t>(word(what));
    if (value < 0) fail_at(0, what + " must not be below 0, as " + std::to_string(value));
    return static_cast<std::uint32_t>(value);
  }

  void read_vertex(std::uint32_t v) {
    const std::string place = "vertex " + std::to_string(v);
    const auto coordinate = [&] { return double{std::bit_cast<float>(word(place))}; };
    const double x = coordinate(), y = coordinate(), z = coordinate();
    if (!is_finite({x, y, z})) fail_at(0, place + " is not finite");
    for (unsigned i = 0; i < more_; ++i) word(place);
    file_.off.mesh.points.push_back({x, y, z});
  }

  void read_face(std::uint32_t f) {
    const std::string place = "face " + std::to_string(f);
    const std::uint32_t sides = count("the number of sides of " + place);
    if (sides > rest_.size() / 4) fail_at(0, "the file ends at " + place);
    corners_.clear();
    for (std::uint32_t i = 0; i < sides; ++i) corners_.push_back(std::bit_cast<std::int32_t>(word(place)));
    add_polygon(file_, corners_, place, 0);
    const std::uint32_t components = count("the colour of " + place);
    if (components > 4) fail_at(0, place + ": " + std::to_string(components) + " components of a colour");
    for (std::uint32_t i = 0; i < components; ++i) word(place);
  }

  std::string_view rest_;
  unsigned more_ = 0;  // numbers per vertex beside the coordinates
  std::vector<std::int64_t> corners_;
  ShapeFile file_;
};

}  // namespace

bool is_binary_off(std::string_view bytes) {
  const std::string_view line = bytes.substr(0, std::min<std::size_t>(bytes.find('\n'), 40));
  const std::size_t word = line.find("OFF");
  return word <= 4 && line.find("BINARY", word) != std::string_view::npos;
}

ShapeFile parse_binary_off(std::string_view bytes) {
  return BinaryOff(bytes).run();
}

}  // namespace affskel::core
