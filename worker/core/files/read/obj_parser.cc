#include <algorithm>

#include "core/files/read/shape_parsers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

// "7", "7/1", "7//3" or "-1" (the last vertex so far), from 1; an index from 0.
std::int64_t corner_of(std::string_view word, std::size_t known, const std::string& what,
                       std::uint64_t line) {
  std::string_view digits = word.substr(0, word.find('/'));
  const bool from_end = digits.starts_with('-');
  if (from_end) digits.remove_prefix(1);
  const std::uint64_t number = parse_count(digits, line, "a vertex index");
  if (number == 0 || number > known) {
    fail_at(line, what + " uses vertex " + quoted_excerpt(word) + "; " + std::to_string(known) +
                      " vertices are known here, counted from 1");
  }
  return static_cast<std::int64_t>(from_end ? known - number : number - 1);
}

// Rows, of which those that end in a backslash go on in the next line.  The format does not say whether a
// word may be cut in two; none is here.
class Statements {
 public:
  explicit Statements(std::string_view bytes) : rows_(bytes) {}

  bool next() {
    do {
      if (!ahead_ && !rows_.next()) return false;
      ahead_ = false;
      line_ = rows_.line();
      words_ = rows_.words();
      join();
    } while (words_.empty());
    return true;
  }

  const std::vector<std::string_view>& words() const { return words_; }
  std::uint64_t line() const { return line_; }  ///< where the statement begins

 private:
  void join() {
    for (std::uint64_t last = line_; goes_on();) {
      if (!rows_.next()) return;
      // Rows without words are skipped, but one of them ends the statement.
      ahead_ = rows_.line() != ++last;
      if (ahead_) return;
      words_.insert(words_.end(), rows_.words().begin(), rows_.words().end());
    }
  }

  // Whether there is a backslash; takes it away.
  bool goes_on() {
    if (words_.empty() || words_.back().back() != '\\') return false;
    words_.back().remove_suffix(1);
    if (words_.back().empty()) words_.pop_back();
    return true;
  }

  TextRows rows_;
  bool ahead_ = false;  // the row that rows_ is at begins the next statement
  std::vector<std::string_view> words_;
  std::uint64_t line_ = 0;
};

void pass_over(std::vector<PassedOver>& all, std::string_view word, std::uint64_t line) {
  constexpr std::size_t kMaxKinds = 32;  // the format has fewer; more is a file of another kind
  constexpr std::size_t kMaxWord = 40;
  const std::string name(word.substr(0, kMaxWord));
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const PassedOver& one) { return one.word == name; });
  if (known != all.end()) {
    ++known->rows;
  } else if (all.size() < kMaxKinds) {
    all.push_back({name, 1, line});
  } else {
    ++all.back().rows;
  }
}

}  // namespace

ShapeFile parse_obj(std::string_view bytes) {
  ShapeFile file;
  Statements rows(bytes);
  std::vector<std::int64_t> corners;
  const auto read_corners = [&](const std::string& what) {
    corners.clear();
    for (std::size_t i = 1; i < rows.words().size(); ++i)
      corners.push_back(corner_of(rows.words()[i], file.off.mesh.points.size(), what, rows.line()));
  };
  while (rows.next()) {
    const auto& words = rows.words();
    if (words[0] == "v") {
      if (words.size() < 4) fail_at(rows.line(), "a vertex needs three coordinates");
      const auto coordinate = [&](std::size_t i) {
        return parse_finite(words[i], rows.line(), "coordinate");
      };
      file.off.mesh.points.push_back({coordinate(1), coordinate(2), coordinate(3)});
      file.off.vertex_line.push_back(static_cast<std::uint32_t>(rows.line()));
    } else if (words[0] == "f") {
      read_corners("a face");
      add_polygon(file, corners, "the face", rows.line());
      file.off.triangle_line.resize(file.off.mesh.triangles.size(), static_cast<std::uint32_t>(rows.line()));
      ++file.off.polygons;
    } else if (words[0] == "l") {
      read_corners("a line");
      add_polyline(file, corners, "the line", rows.line());
    } else {
      pass_over(file.off.passed_over, words[0], rows.line());
    }
  }
  if (file.off.mesh.points.empty()) fail_at(rows.line(), "no vertices (rows that begin with v)");
  return file;
}

}  // namespace affskel::core
