#include <string>

#include "base/coding.h"
#include "core/files/read/shape_parsers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;

ShapeFile parse_binary(std::string_view bytes) {
  CornerSurface surface;
  for (std::size_t at = kHeader; at < bytes.size(); at += kFacet) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto coordinate = [&](std::size_t k) {
        return double{base::decode<float>(bytes.data() + at + 12 + 12 * c + 4 * k)};
      };
      const Vec3 p{coordinate(0), coordinate(1), coordinate(2)};
      if (!is_finite(p)) {
        fail_at(0,
                "triangle " + std::to_string((at - kHeader) / kFacet) + " has a corner that is not finite");
      }
      surface.add(p);
    }
  }
  return surface.take();
}

// The rows of a text file in the only order that they may have:
// solid (facet (outer loop, three times vertex, endloop) endfacet)* endsolid, once or more.
class TextReader {
 public:
  explicit TextReader(std::string_view bytes) : rows_(bytes) {}

  ShapeFile run() {
    while (rows_.next()) {
      const std::string_view word = rows_.words()[0];
      if (outside_) {
        expect(is(word, "solid"), "solid");
        outside_ = false;
      } else if (is(word, "endsolid")) {
        outside_ = true;
      } else {
        expect(is(word, "facet"), "facet or endsolid");
        read_facet();
      }
    }
    if (!outside_) fail_at(rows_.line(), "the file ends before endsolid");
    return surface_.take();
  }

 private:
  // Some programs write capitals.
  static bool is(std::string_view word, std::string_view wanted) {
    return word == wanted || same_but_for_case(word, wanted);
  }

  void expect(bool met, const char* what) const {
    if (!met)
      fail_at(rows_.line(), std::string("expected ") + what + ", not " + quoted_excerpt(rows_.text()));
  }

  const std::vector<std::string_view>& next(const char* what) {
    if (!rows_.next()) fail_at(rows_.line(), std::string("the file ends before ") + what);
    return rows_.words();
  }

  void read_facet() {
    const auto& words = next("outer loop");
    expect(words.size() == 2 && is(words[0], "outer") && is(words[1], "loop"), "outer loop");
    for (int corner = 0; corner < 3; ++corner) read_vertex(corner);
    expect(is(next("endloop")[0], "endloop"), "endloop after three vertices");
    expect(is(next("endfacet")[0], "endfacet"), "endfacet");
  }

  void read_vertex(int known) {
    const auto& words = next("a vertex");
    if (is(words[0], "endloop")) {
      fail_at(rows_.line(), "a facet of " + std::to_string(known) + " vertices, needs 3");
    }
    expect(is(words[0], "vertex"), "vertex");
    if (words.size() != 4) fail_at(rows_.line(), "a vertex needs three coordinates");
    const auto coordinate = [&](std::size_t i) { return parse_finite(words[i], rows_.line(), "coordinate"); };
    surface_.add({coordinate(1), coordinate(2), coordinate(3)});
  }

  TextRows rows_;
  CornerSurface surface_;
  bool outside_ = true;
};

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= kHeader &&
         bytes.size() == kHeader + kFacet * std::size_t{base::decode<std::uint32_t>(bytes.data() + 80)};
}

bool is_text_stl(std::string_view bytes) {
  return same_but_for_case(first_word(bytes), "solid");
}

ShapeFile parse_stl(std::string_view bytes) {
  // Some binary files begin with "solid", too; the size tells.
  if (is_binary_stl(bytes)) return parse_binary(bytes);
  if (is_text_stl(bytes)) return TextReader(bytes).run();
  fail_at(
      0, "not an STL file: neither text that begins with 'solid' nor as long as its count of triangles says");
}

}  // namespace affskel::core
