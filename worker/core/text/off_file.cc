#include "core/text/off_file.h"

#include <algorithm>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/mesh/polygon_cut.h"
#include "core/mesh/quad_diagonals.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

constexpr std::uint64_t kMaxElements = std::uint64_t{1} << 28;

class OffReader {
 public:
  OffReader(std::string_view bytes, ExecutionContext* context) : rows_(bytes), stop_(context) {}

  OffMesh run() {
    read_header();
    read_counts();
    read_vertices();
    read_faces();
    refuse_more_rows();
    return std::move(result_);
  }

 private:
  void refuse_more_rows() {
    if (!rows_.next()) return;
    const std::uint64_t line = rows_.line();
    const std::string first = quoted_excerpt(rows_.words()[0]);
    std::uint64_t more = 1;
    while (rows_.next()) ++more;
    fail_at(line, "more rows than the " + std::to_string(vertex_count_) + " vertices and " +
                      std::to_string(face_count_) + " faces announced: " + first +
                      "; if they are faces, announce " + std::to_string(face_count_ + more) + " in line " +
                      std::to_string(counts_line_));
  }

  void read_header() {
    if (!rows_.next()) fail_at(1, "the file is empty; expected an OFF header");
    std::string_view word = rows_.words()[0];
    const auto take = [&word](std::string_view prefix) {
      const bool taken = word.starts_with(prefix);
      if (taken) word.remove_prefix(prefix.size());
      return taken;
    };
    texture_ = take("ST");
    colour_ = take("C");
    normal_ = take("N");
    if (word == "4OFF") {
      homogeneous_ = true;
      word.remove_prefix(1);
    }
    if (word == "nOFF" || word == "4nOFF") {
      fail_at(rows_.line(), "points of any number of coordinates (" + std::string(word) +
                                ") are not read; expected [ST][C][N][4]OFF");
    }
    if (word != "OFF") {
      fail_at(rows_.line(), "not an OFF file: starts with " + quoted_excerpt(rows_.words()[0]) +
                                ", expected the header [ST][C][N][4]OFF");
    }
    rows_.drop_first_word();
    if (!rows_.words().empty() && rows_.words()[0] == "BINARY") {
      fail_at(rows_.line(), "binary OFF where text is wanted");
    }
  }

  void read_counts() {
    if (rows_.words().empty() && !rows_.next()) fail_at(rows_.line(), "the file ends before the counts");
    const auto& words = rows_.words();
    if (words.size() != 2 && words.size() != 3) {
      fail_at(rows_.line(), "expected the counts of vertices, faces and (optionally) edges, found " +
                                std::to_string(words.size()) + " words");
    }
    vertex_count_ = parse_count(words[0], rows_.line(), "the vertex count");
    face_count_ = parse_count(words[1], rows_.line(), "the face count");
    if (words.size() == 3) parse_count(words[2], rows_.line(), "the edge count");
    counts_line_ = rows_.line();
    check_count(vertex_count_, "vertices", 6);
    check_count(face_count_, "faces", 8);
  }

  // Refuses what cannot be true before anything is allocated; a row has at least min_bytes bytes.
  void check_count(std::uint64_t count, const char* what, std::uint64_t min_bytes) const {
    if (count > kMaxElements) {
      throw CoreError(CoreError::Code::kLimit,
                      "line " + std::to_string(rows_.line()) + ": " + std::to_string(count) + " " + what +
                          " announced, at most " + std::to_string(kMaxElements) + " are supported",
                      rows_.line());
    }
    if (count > rows_.bytes_left() / min_bytes + 1) {
      fail_at(rows_.line(), std::to_string(count) + " " + what + " announced, but only " +
                                std::to_string(rows_.bytes_left()) + " bytes follow");
    }
  }

  void read_vertices() {
    result_.mesh.points.reserve(vertex_count_);
    result_.vertex_line.reserve(vertex_count_);
    const std::size_t base = coordinates() + (normal_ ? 3U : 0U) + (texture_ ? 2U : 0U);
    for (std::uint64_t v = 0; v < vertex_count_; ++v) {
      stop_.did(kStepsPerRow);
      if (!rows_.next()) ends_early("vertex", v, vertex_count_);
      const auto& words = rows_.words();
      if (v == 0 && is_plain() && (words.size() == 6 || words.size() == 7)) unpromised_ = words.size() - 3;
      const bool fits =
          colour_ ? words.size() == base + 3 || words.size() == base + 4 : words.size() == base + unpromised_;
      if (!fits) {
        fail_at(rows_.line(),
                "vertex " + std::to_string(v) + " has " + std::to_string(words.size()) +
                    (unpromised_ > 0 ? " numbers, those before have " : " numbers, the header promises ") +
                    std::to_string(base + unpromised_ + (colour_ ? 3 : 0)) +
                    (colour_ ? " or " + std::to_string(base + 4) : std::string()));
      }
      for (std::size_t i = coordinates(); i < words.size(); ++i)
        parse_finite(words[i], rows_.line(), "vertex attribute");
      result_.mesh.points.push_back(place(v));
      result_.vertex_line.push_back(static_cast<std::uint32_t>(rows_.line()));
    }
    if (unpromised_ > 0)
      result_.passed_over.push_back({"numbers after the coordinates", vertex_count_, result_.vertex_line[0]});
  }

  bool is_plain() const { return !colour_ && !normal_ && !texture_ && !homogeneous_; }
  std::size_t coordinates() const { return homogeneous_ ? 4 : 3; }

  Vec3 place(std::uint64_t v) const {
    const Vec3 p{coordinate(0), coordinate(1), coordinate(2)};
    if (!homogeneous_) return p;
    const double w = coordinate(3);
    const Vec3 at = p / w;
    if (!is_finite(at)) fail_at(rows_.line(), "vertex " + std::to_string(v) + " lies at infinity");
    return at;
  }

  double coordinate(std::size_t i) const {
    return parse_finite(rows_.words()[i], rows_.line(), "coordinate");
  }

  void read_faces() {
    result_.mesh.triangles.reserve(face_count_);
    result_.triangle_line.reserve(face_count_);
    for (std::uint64_t f = 0; f < face_count_; ++f) {
      stop_.did(kStepsPerRow);
      if (!rows_.next()) ends_early("face", f, face_count_);
      read_face(f);
    }
    result_.polygons = face_count_;
    turn_doubled_diagonals(quads_, result_.mesh.triangles);
  }

  void read_face(std::uint64_t f) {
    const auto& words = rows_.words();
    const std::uint64_t sides = parse_count(words[0], rows_.line(), "the number of sides");
    if (sides < 3) {
      fail_at(rows_.line(),
              "face " + std::to_string(f) + " has " + std::to_string(sides) + " sides, needs 3");
    }
    if (words.size() - 1 < sides) {
      fail_at(rows_.line(), "face " + std::to_string(f) + " announces " + std::to_string(sides) +
                                " vertices, the line has " + std::to_string(words.size() - 1));
    }
    const std::size_t extra = words.size() - 1 - sides;
    if (extra == 2 || extra > 4) {
      fail_at(rows_.line(), "face " + std::to_string(f) + ": " + std::to_string(extra) +
                                " numbers after the vertices; a colour has 1, 3 or 4");
    }
    for (std::size_t i = 1 + sides; i < words.size(); ++i) parse_finite(words[i], rows_.line(), "colour");
    read_corners(f, sides);
    const std::size_t before = result_.mesh.triangles.size();
    // Up to the square of the number of sides; see cut_polygon.
    stop_.did(sides <= kMaxEarCorners ? sides * sides : sides);
    // A triangle with a corner twice has no area, which is for users of the mesh to judge.
    if (const auto twice = add_polygon(result_, corners_, rows_.line(), quads_))
      fail_at(rows_.line(),
              "face " + std::to_string(f) + " uses vertex " + std::to_string(*twice) + " twice");
    result_.triangle_line.insert(result_.triangle_line.end(), result_.mesh.triangles.size() - before,
                                 static_cast<std::uint32_t>(rows_.line()));
  }

  void read_corners(std::uint64_t f, std::uint64_t sides) {
    corners_.clear();
    for (std::uint64_t i = 0; i < sides; ++i) {
      const std::uint64_t v = parse_count(rows_.words()[1 + i], rows_.line(), "a vertex index");
      if (v >= vertex_count_) {
        fail_at(rows_.line(), "face " + std::to_string(f) + " uses vertex " + std::to_string(v) +
                                  "; indices run from 0 to " + std::to_string(vertex_count_ - 1));
      }
      corners_.push_back(static_cast<std::uint32_t>(v));
    }
  }

  [[noreturn]] void ends_early(const char* what, std::uint64_t at, std::uint64_t count) const {
    fail_at(rows_.line(), "the file ends after " + std::to_string(at) + " of " + std::to_string(count) + " " +
                              what + " rows");
  }

  static constexpr std::uint64_t kStepsPerRow = 64;

  TextRows rows_;
  StopCheck stop_;
  bool texture_ = false, colour_ = false, normal_ = false, homogeneous_ = false;
  std::size_t unpromised_ = 0;  // numbers per vertex that the header does not promise
  std::uint64_t vertex_count_ = 0, face_count_ = 0, counts_line_ = 0;
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> quads_;  // first triangles of the faces with four sides
  OffMesh result_;
};

}  // namespace

std::optional<std::uint32_t> add_polygon(OffMesh& off, std::span<const std::uint32_t> corners,
                                         std::uint64_t line, std::vector<std::uint32_t>& quads) {
  Mesh& mesh = off.mesh;
  if (corners.size() > 3) {
    std::vector<std::uint32_t> sorted(corners.begin(), corners.end());
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) return *twice;
    const Unevenness found = unevenness(mesh.points, corners);
    ++off.polygons_cut;
    off.uneven_volume += found.volume;
    if (found.distance > off.uneven_distance) {
      off.uneven_distance = found.distance;
      off.uneven_line = line;
    }
  }
  if (corners.size() == 4) quads.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
  cut_polygon(mesh.points, corners, mesh.triangles);
  return std::nullopt;
}

OffMesh read_off(std::string_view bytes, ExecutionContext* context) {
  return OffReader(bytes, context).run();
}

std::string write_off(const Mesh& mesh) {
  std::string text =
      "OFF\n" + std::to_string(mesh.points.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
  // The longest rows that there are: what is not written takes no memory, what grows is there twice.
  text.reserve(text.size() + 75 * mesh.points.size() + 35 * mesh.triangles.size());
  for (const Vec3& p : mesh.points) {
    base::append_shortest(text, p.x);
    text.push_back(' ');
    base::append_shortest(text, p.y);
    text.push_back(' ');
    base::append_shortest(text, p.z);
    text.push_back('\n');
  }
  for (const Triangle& t : mesh.triangles) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return text;
}

}  // namespace affskel::core
