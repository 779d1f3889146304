#include "core/files/read/ply_header.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>

#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

template <class Number>
constexpr PlyType type_of(std::string_view name, std::string_view other_name) {
  using Limits = std::numeric_limits<Number>;
  return {{name, other_name}, base::kNumberKind<Number>, Limits::is_integer, Limits::lowest(), Limits::max()};
}
constexpr std::array<PlyType, 8> kTypes = {
    type_of<std::int8_t>("char", "int8"),    type_of<std::uint8_t>("uchar", "uint8"),
    type_of<std::int16_t>("short", "int16"), type_of<std::uint16_t>("ushort", "uint16"),
    type_of<std::int32_t>("int", "int32"),   type_of<std::uint32_t>("uint", "uint32"),
    type_of<float>("float", "float32"),      type_of<double>("double", "float64")};

const PlyType* parse_type(std::string_view word, std::uint64_t line) {
  for (const PlyType& type : kTypes) {
    if (word == type.names[0] || word == type.names[1]) return &type;
  }
  fail_at(line, "unknown type " + quoted_excerpt(word));
}

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : rest_(bytes) {
    const std::size_t end = bytes.find_first_of("\r\n");
    // Behind a CR that ends the header binary numbers may begin with an LF, so the first row tells for all.
    if (end != std::string_view::npos && bytes.substr(end, 2) != "\r\n") end_ = bytes[end];
  }

  PlyHeader run() {
    if (!next() || words_ != std::vector<std::string_view>{"ply"})
      fail("not a PLY file: must begin with 'ply'");
    bool has_format = false;
    while (next()) {
      if (words_.empty() || words_[0] == "obj_info") continue;
      if (words_[0] == "comment") {
        read_comment();
        continue;
      }
      if (words_[0] == "end_header") {
        if (!has_format) fail("the header names no format");
        header_.body = rest_;
        return std::move(header_);
      }
      if (words_[0] == "format") {
        if (has_format) fail("a second row names a format");
        read_format();
        has_format = true;
      } else if (words_[0] == "element") {
        read_element();
      } else if (words_[0] == "property") {
        read_property();
      } else {
        fail("not a row of a PLY header: " + quoted_excerpt(words_[0]));
      }
    }
    fail("the file ends before end_header");
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    fail_at(std::max<std::uint64_t>(header_.lines, 1), message);
  }

  // Of all comments one means something, see kPlyCurves.
  void read_comment() {
    if (words_.size() < 3 || words_[1] != "curves") return;
    const std::string_view count = words_[2];
    std::uint64_t faces = 0;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), faces);
    if (error == std::errc() && end == count.data() + count.size()) header_.curve_faces = faces;
  }

  // The body may be binary, so rows are taken one by one, up to end_header.
  bool next() {
    const std::size_t end = rest_.find(end_);
    if (end == std::string_view::npos) return false;
    TextWords row(rest_.substr(0, end));
    rest_ = rest_.substr(end + 1);
    ++header_.lines;
    words_.clear();
    for (std::string_view word = row.next(); !word.empty(); word = row.next()) words_.push_back(word);
    return true;
  }

  void read_format() {
    if (words_.size() != 3 || words_[2] != "1.0") fail("expected 'format ENCODING 1.0'");
    if (words_[1] == "ascii") {
      header_.encoding = PlyEncoding::kText;
    } else if (words_[1] == "binary_little_endian") {
      header_.encoding = PlyEncoding::kLittle;
    } else if (words_[1] == "binary_big_endian") {
      header_.encoding = PlyEncoding::kBig;
    } else {
      fail("unknown encoding " + quoted_excerpt(words_[1]));
    }
  }

  void read_element() {
    if (words_.size() != 3) fail("expected 'element NAME COUNT'");
    names_.clear();
    header_.elements.push_back(
        {std::string(words_[1]), parse_count(words_[2], header_.lines, "the count"), {}});
  }

  void read_property() {
    if (header_.elements.empty()) fail("a property before the first element");
    PlyProperty property;
    if (words_.size() == 5 && words_[1] == "list") {
      property.list = true;
      property.count_type = parse_type(words_[2], header_.lines);
      property.type = parse_type(words_[3], header_.lines);
      if (!property.count_type->whole) fail("the length of a list must be of a whole type");
    } else if (words_.size() == 3) {
      property.type = parse_type(words_[1], header_.lines);
    } else {
      fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    }
    property.name = std::string(words_.back());
    if (!names_.insert(words_.back()).second) {
      fail("two properties of element " + quoted_excerpt(header_.elements.back().name) + " are called " +
           quoted_excerpt(property.name));
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view rest_;
  char end_ = '\n';  // of a row
  std::vector<std::string_view> words_;
  std::set<std::string_view> names_;  // of the last element's properties
  PlyHeader header_;
};

}  // namespace

PlyHeader read_ply_header(std::string_view bytes) {
  return HeaderReader(bytes).run();
}

}  // namespace affskel::core
