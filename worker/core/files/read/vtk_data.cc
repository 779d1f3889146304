// The three ways in which VTK XML files hold numbers (VTK User's Guide, "XML File Formats"): as text; as
// base64 between the tags; and appended behind the text, as base64 or as they are, `offset` from an
// underscore.  In front of binary numbers stands how many bytes they take, encoded together with them.
#include "core/files/read/vtk_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/coding.h"
#include "core/files/base64.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

struct Type {
  std::string_view name;
  bool whole;
  base::NumberKind kind;
};

template <typename Number>
constexpr Type type_of(std::string_view name) {
  return {name, std::is_integral_v<Number>, base::kNumberKind<Number>};
}

constexpr std::array<Type, 10> kTypes = {type_of<std::int8_t>("Int8"),   type_of<std::uint8_t>("UInt8"),
                                         type_of<std::int16_t>("Int16"), type_of<std::uint16_t>("UInt16"),
                                         type_of<std::int32_t>("Int32"), type_of<std::uint32_t>("UInt32"),
                                         type_of<std::int64_t>("Int64"), type_of<std::uint64_t>("UInt64"),
                                         type_of<float>("Float32"),      type_of<double>("Float64")};

const Type* find_type(std::string_view name) {
  const auto found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& t) { return t.name == name; });
  return found == kTypes.end() ? nullptr : &*found;
}

class Decoder {
 public:
  Decoder(const VtkArray& array, const VtkEncoding& encoding) : array_(array), encoding_(encoding) {}

  base::PackedNumbers run() const {
    const Type* type = find_type(array_.type);
    if (type == nullptr) fail("has the type " + quoted_excerpt(array_.type));
    if (array_.format == "ascii") return words(*type);
    if (!encoding_.compressor.empty()) {
      fail("is compressed (" + quoted_excerpt(encoding_.compressor) +
           "), which is not read; save it without compression");
    }
    if (array_.format == "binary") {
      return owned_numbers(from_base64(array_.text), *type);
    }
    if (array_.format != "appended") fail("has the format " + quoted_excerpt(array_.format));
    const std::uint64_t offset = parse_count(array_.offset, array_.line, "the offset");
    if (offset > encoding_.appended.size()) fail("begins behind the end of the file");
    const std::string_view rest = encoding_.appended.substr(offset);
    return encoding_.base64 ? appended_base64(rest, *type) : numbers_of(body(rest), *type);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    fail_at(array_.line, "array " + quoted_excerpt(array_.name) + " " + what);
  }

  base::PackedNumbers words(const Type& type) const {
    std::string values;
    TextWords text(array_.text);
    for (std::string_view word = text.next(); !word.empty(); word = text.next()) {
      const double value = parse_number(word, array_.line, "a value");
      if (type.whole && value != std::floor(value))
        fail("holds " + quoted_excerpt(word) + ", which is not a whole number");
      base::append(values, value);
    }
    return {std::move(values), base::kNumberKind<double>};
  }

  std::string from_base64(std::string_view text) const {
    std::optional<std::string> bytes = bytes_of_base64(text);
    if (!bytes) fail("is not base64");
    return std::move(*bytes);
  }

  std::size_t header_size() const { return encoding_.long_headers ? 8 : 4; }

  std::uint64_t announced(std::string_view bytes) const {
    if (bytes.size() < header_size()) fail("ends before its length");
    return encoding_.long_headers ? base::decode_ordered<std::uint64_t>(bytes.data(), encoding_.big_endian)
                                  : base::decode_ordered<std::uint32_t>(bytes.data(), encoding_.big_endian);
  }

  // The bytes behind the header that gives their number.
  std::string_view body(std::string_view bytes) const {
    const std::uint64_t length = announced(bytes);
    if (length > bytes.size() - header_size()) {
      fail("announces " + std::to_string(length) + " bytes, but only " +
           std::to_string(bytes.size() - header_size()) + " follow");
    }
    return bytes.substr(header_size(), length);
  }

  base::PackedNumbers owned_numbers(std::string&& bytes, const Type& type) const {
    const std::size_t length = body(bytes).size();
    bytes.resize(header_size() + length);
    return numbers_of(std::move(bytes.erase(0, header_size())), type);
  }

  // Other arrays follow without a separator: the header gives the length of this one.
  base::PackedNumbers appended_base64(std::string_view text, const Type& type) const {
    constexpr std::size_t kHead = 12;  // digits that hold any header
    const std::uint64_t length = announced(from_base64(text.substr(0, kHead)));
    if (length > text.size()) fail("announces " + std::to_string(length) + " bytes, more than follow");
    const std::size_t digits = (header_size() + length + 2) / 3 * 4;
    return owned_numbers(from_base64(text.substr(0, digits)), type);
  }

  template <class Bytes>
  base::PackedNumbers numbers_of(Bytes&& bytes, const Type& type) const {
    if (bytes.size() % type.kind.bytes != 0) fail("has half a number at its end");
    return {std::forward<Bytes>(bytes), type.kind, encoding_.big_endian};
  }

  const VtkArray& array_;
  const VtkEncoding& encoding_;
};

}  // namespace

bool is_vtk_number(std::string_view type) {
  return find_type(type) != nullptr;
}

bool is_vtk_whole(std::string_view type) {
  const Type* found = find_type(type);
  return found != nullptr && found->whole;
}

base::PackedNumbers vtk_numbers(const VtkArray& array, const VtkEncoding& encoding) {
  return Decoder(array, encoding).run();
}

}  // namespace affskel::core
