#include "core/mesh_io.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/polygon_cut.h"

namespace affskel::core {
namespace {

[[noreturn]] void fail(std::uint64_t line, const std::string& message) {
  throw CoreError(CoreError::Code::kBadInput, "line " + std::to_string(line) + ": " + message, line);
}

// A piece of the file for a message: short, and printable whatever the bytes are.
std::string quoted(std::string_view text) {
  std::string shown = "'";
  for (char c : text.substr(0, 40)) shown.push_back(c >= ' ' && c < 127 ? c : '?');
  return shown + (text.size() > 40 ? "...'" : "'");
}

enum class Kind : std::uint8_t { kWord, kBlank, kSpecial };

constexpr std::array<Kind, 256> kind_table() {
  std::array<Kind, 256> kinds{};
  for (char c : {' ', '\t', '\v', '\f'}) kinds[static_cast<unsigned char>(c)] = Kind::kBlank;
  for (char c : {'\0', '\r', '#'}) kinds[static_cast<unsigned char>(c)] = Kind::kSpecial;
  return kinds;
}
constexpr std::array<Kind, 256> kKinds = kind_table();

inline Kind kind_of(char c) {
  return kKinds[static_cast<unsigned char>(c)];
}

// Rows of an OFF file: lines without comments and line ends, blank ones skipped, cut into words.
class Rows {
 public:
  explicit Rows(std::string_view bytes) : rest_(bytes) {}

  // Moves on to the next row that holds words; false at the end of the file.
  bool next() {
    while (!rest_.empty()) {
      ++line_;
      const std::size_t end = rest_.find('\n');
      std::string_view text = rest_.substr(0, end);
      rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
      split(text);
      if (!words_.empty()) return true;
    }
    return false;
  }

  std::uint64_t line() const { return line_; }
  std::size_t bytes_left() const { return rest_.size(); }
  const std::vector<std::string_view>& words() const { return words_; }
  void drop_first_word() { words_.erase(words_.begin()); }

 private:
  // Most lines are plain words between blanks: one look at each character.
  void split(std::string_view text) {
    words_.clear();
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    const char* at = text.data();
    const char* const end = at + text.size();
    for (;;) {
      while (at != end && kind_of(*at) == Kind::kBlank) ++at;
      const char* const begin = at;
      while (at != end && kind_of(*at) == Kind::kWord) ++at;
      if (at != end && kind_of(*at) == Kind::kSpecial) return split_carefully(text);
      if (at == begin) return;
      words_.emplace_back(begin, static_cast<std::size_t>(at - begin));
    }
  }

  // Lines with comments or with characters that do not belong into text.
  void split_carefully(std::string_view text) {
    words_.clear();
    if (text.find('\0') != std::string_view::npos) fail(line_, "a NUL byte in what should be text");
    text = text.substr(0, text.find('#'));
    if (text.find('\r') != std::string_view::npos) {
      fail(line_, "a carriage return inside the line (old Macintosh line ends are not supported)");
    }
    std::size_t at = 0;
    while ((at = text.find_first_not_of(" \t\v\f", at)) != std::string_view::npos) {
      const std::size_t stop = std::min(text.find_first_of(" \t\v\f", at), text.size());
      words_.push_back(text.substr(at, stop - at));
      at = stop;
    }
  }

  std::string_view rest_;
  std::uint64_t line_ = 0;
  std::vector<std::string_view> words_;
};

std::uint64_t parse_count(std::string_view word, std::uint64_t line, const char* what) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) {
    fail(line, std::string(what) + " must be a whole number >= 0, not " + quoted(word));
  }
  return value;
}

double parse_number(std::string_view word, std::uint64_t line, const char* what) {
  std::string_view digits = word;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    fail(line, std::string(what) + " " + quoted(word) + " is outside the range of a double");
  }
  if (error != std::errc{} || end != digits.data() + digits.size() || digits.front() == '+') {
    fail(line, std::string(what) + " must be a number, not " + quoted(word));
  }
  if (!std::isfinite(value)) fail(line, std::string(what) + " " + quoted(word) + " is not finite");
  return value;
}

class OffReader {
 public:
  OffReader(std::string_view bytes, const ReadOffOptions& options) : rows_(bytes), options_(options) {}

  OffMesh run() {
    read_header();
    read_counts();
    read_vertices();
    read_faces();
    if (rows_.next()) {
      fail(rows_.line(), "more rows than the " + std::to_string(vertex_count_) + " vertices and " +
                             std::to_string(face_count_) + " faces announced: " + quoted(rows_.words()[0]));
    }
    return std::move(result_);
  }

 private:
  void read_header() {
    if (!rows_.next()) fail(1, "the file is empty; expected an OFF header");
    std::string_view word = rows_.words()[0];
    if (word.substr(0, 2) == "ST") {
      texture_ = true;
      word.remove_prefix(2);
    }
    if (!word.empty() && word.front() == 'C') {
      colour_ = true;
      word.remove_prefix(1);
    }
    if (!word.empty() && word.front() == 'N') {
      normal_ = true;
      word.remove_prefix(1);
    }
    if (word == "4OFF" || word == "nOFF" || word == "4nOFF") {
      fail(rows_.line(), "homogeneous or higher-dimensional coordinates (" + std::string(word) +
                             ") are not supported; expected [ST][C][N]OFF");
    }
    if (word != "OFF") {
      fail(rows_.line(), "not an OFF file: starts with " + quoted(rows_.words()[0]) +
                             ", expected the header [ST][C][N]OFF");
    }
    rows_.drop_first_word();
    if (!rows_.words().empty() && rows_.words()[0] == "BINARY") {
      fail(rows_.line(), "binary OFF is not supported; write the mesh as text");
    }
  }

  void read_counts() {
    if (rows_.words().empty() && !rows_.next()) fail(rows_.line(), "the file ends before the counts");
    const auto& words = rows_.words();
    if (words.size() != 2 && words.size() != 3) {
      fail(rows_.line(), "expected the counts of vertices, faces and (optionally) edges, found " +
                             std::to_string(words.size()) + " words");
    }
    vertex_count_ = parse_count(words[0], rows_.line(), "the vertex count");
    face_count_ = parse_count(words[1], rows_.line(), "the face count");
    if (words.size() == 3) parse_count(words[2], rows_.line(), "the edge count");
    check_count(vertex_count_, "vertices", 6);
    check_count(face_count_, "faces", 8);
  }

  // Refuses what cannot be true before anything is allocated; a row has at least min_bytes bytes.
  void check_count(std::uint64_t count, const char* what, std::uint64_t min_bytes) const {
    if (count > options_.max_elements) {
      throw CoreError(CoreError::Code::kLimit,
                      "line " + std::to_string(rows_.line()) + ": " + std::to_string(count) + " " + what +
                          " announced, at most " + std::to_string(options_.max_elements) + " are supported",
                      rows_.line());
    }
    if (count > rows_.bytes_left() / min_bytes + 1) {
      fail(rows_.line(), std::to_string(count) + " " + what + " announced, but only " +
                             std::to_string(rows_.bytes_left()) + " bytes follow");
    }
  }

  void read_vertices() {
    result_.mesh.points.reserve(vertex_count_);
    result_.vertex_line.reserve(vertex_count_);
    const std::size_t base = 3 + (normal_ ? 3U : 0U) + (texture_ ? 2U : 0U);
    for (std::uint64_t v = 0; v < vertex_count_; ++v) {
      if (!rows_.next()) ends_early("vertex", v, vertex_count_);
      const auto& words = rows_.words();
      const bool fits = colour_ ? words.size() == base + 3 || words.size() == base + 4 : words.size() == base;
      if (!fits) {
        fail(rows_.line(), "vertex " + std::to_string(v) + " has " + std::to_string(words.size()) +
                               " numbers, the header promises " + std::to_string(base + (colour_ ? 3 : 0)) +
                               (colour_ ? " or " + std::to_string(base + 4) : std::string()));
      }
      for (std::size_t i = 3; i < words.size(); ++i) parse_number(words[i], rows_.line(), "vertex attribute");
      result_.mesh.points.push_back({coordinate(0), coordinate(1), coordinate(2)});
      result_.vertex_line.push_back(static_cast<std::uint32_t>(rows_.line()));
    }
  }

  double coordinate(std::size_t i) const {
    return parse_number(rows_.words()[i], rows_.line(), "coordinate");
  }

  void read_faces() {
    result_.mesh.triangles.reserve(face_count_);
    result_.triangle_line.reserve(face_count_);
    for (std::uint64_t f = 0; f < face_count_; ++f) {
      if (!rows_.next()) ends_early("face", f, face_count_);
      read_face(f);
    }
    result_.polygons = face_count_;
  }

  void read_face(std::uint64_t f) {
    const auto& words = rows_.words();
    const std::uint64_t sides = parse_count(words[0], rows_.line(), "the number of sides");
    if (sides < 3) {
      fail(rows_.line(), "face " + std::to_string(f) + " has " + std::to_string(sides) + " sides, needs 3");
    }
    if (words.size() - 1 < sides) {
      fail(rows_.line(), "face " + std::to_string(f) + " announces " + std::to_string(sides) +
                             " vertices, the line has " + std::to_string(words.size() - 1));
    }
    const std::size_t extra = words.size() - 1 - sides;
    if (extra == 2 || extra > 4) {
      fail(rows_.line(), "face " + std::to_string(f) + ": " + std::to_string(extra) +
                             " numbers after the vertices; a colour has 1, 3 or 4");
    }
    for (std::size_t i = 1 + sides; i < words.size(); ++i) parse_number(words[i], rows_.line(), "colour");
    read_corners(f, sides);
    const std::size_t before = result_.mesh.triangles.size();
    cut_polygon(result_.mesh.points, corners_, result_.mesh.triangles);
    result_.triangle_line.insert(result_.triangle_line.end(), result_.mesh.triangles.size() - before,
                                 static_cast<std::uint32_t>(rows_.line()));
    if (sides > 3) ++result_.polygons_cut;
  }

  void read_corners(std::uint64_t f, std::uint64_t sides) {
    corners_.clear();
    for (std::uint64_t i = 0; i < sides; ++i) {
      const std::uint64_t v = parse_count(rows_.words()[1 + i], rows_.line(), "a vertex index");
      if (v >= vertex_count_) {
        fail(rows_.line(), "face " + std::to_string(f) + " uses vertex " + std::to_string(v) +
                               "; indices run from 0 to " + std::to_string(vertex_count_ - 1));
      }
      corners_.push_back(static_cast<std::uint32_t>(v));
    }
    if (const auto twice = repeated_corner()) {
      fail(rows_.line(), "face " + std::to_string(f) + " uses vertex " + std::to_string(*twice) + " twice");
    }
  }

  std::optional<std::uint32_t> repeated_corner() {
    if (corners_.size() == 3 && corners_[0] != corners_[1] && corners_[1] != corners_[2] &&
        corners_[2] != corners_[0]) {
      return std::nullopt;
    }
    sorted_ = corners_;
    std::sort(sorted_.begin(), sorted_.end());
    const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end());
    return twice == sorted_.end() ? std::nullopt : std::optional(*twice);
  }

  [[noreturn]] void ends_early(const char* what, std::uint64_t at, std::uint64_t count) const {
    fail(rows_.line(),
         "the file ends after " + std::to_string(at) + " of " + std::to_string(count) + " " + what + " rows");
  }

  Rows rows_;
  ReadOffOptions options_;
  bool texture_ = false, colour_ = false, normal_ = false;
  std::uint64_t vertex_count_ = 0, face_count_ = 0;
  std::vector<std::uint32_t> corners_, sorted_;
  OffMesh result_;
};

void append_number(std::string& text, double value) {
  char digits[32];
  const auto result = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, result.ptr);
}

}  // namespace

OffMesh read_off(std::string_view bytes, const ReadOffOptions& options) {
  return OffReader(bytes, options).run();
}

std::string write_off(const Mesh& mesh) {
  std::string text =
      "OFF\n" + std::to_string(mesh.points.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Vec3& p : mesh.points) {
    append_number(text, p.x);
    text.push_back(' ');
    append_number(text, p.y);
    text.push_back(' ');
    append_number(text, p.z);
    text.push_back('\n');
  }
  for (const Triangle& t : mesh.triangles) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return text;
}

}  // namespace affskel::core
