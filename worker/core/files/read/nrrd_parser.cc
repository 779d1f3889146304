// NRRD, see teem.sourceforge.net/nrrd/format.html.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/coding.h"
#include "base/lower_case.h"
#include "core/files/read/unpack.h"
#include "core/files/read/voxel_header.h"
#include "core/files/read/voxel_numbers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

base::NumberKind nrrd_kind(const VoxelHeader& header) {
  static const std::vector<std::pair<base::NumberKind, std::vector<std::string_view>>> kNames = {
      {base::kNumberKind<std::int8_t>, {"signed char", "int8", "int8_t"}},
      {base::kNumberKind<std::uint8_t>, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {base::kNumberKind<std::int16_t>,
       {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {base::kNumberKind<std::uint16_t>,
       {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {base::kNumberKind<std::int32_t>, {"int", "signed int", "int32", "int32_t"}},
      {base::kNumberKind<std::uint32_t>, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {base::kNumberKind<std::int64_t>,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
        "int64_t"}},
      {base::kNumberKind<std::uint64_t>,
       {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {base::kNumberKind<float>, {"float"}},
      {base::kNumberKind<double>, {"double"}}};
  const std::string type = base::lower_case(header.word("type"));
  for (const auto& [kind, names] : kNames)
    if (std::find(names.begin(), names.end(), type) != names.end()) return kind;
  fail_at(header.line("type"), "unknown type of values '" + header.word("type") + "'");
}

// Of the image's axes, the first of the three in space: before it there may be that of the values at a place, a single one.
std::size_t first_in_space(const std::vector<double>& sizes) {
  return sizes.size() == 4 && sizes[0] == 1 && sizes[3] != 1 ? 1 : 0;
}

// @param axes of the image. @param first of the three in space.
AffineMap nrrd_place(const VoxelHeader& header, std::size_t axes, std::size_t first) {
  const std::vector<double> origin =
      header.has("space origin") ? header.numbers("space origin", 3) : std::vector<double>(3, 0);
  const Vec3 shift{origin[0], origin[1], origin[2]};
  if (header.has("space directions")) {
    const auto d = header.numbers("space directions", 9);
    return place_of({{d[0], d[1], d[2]}, {d[3], d[4], d[5]}, {d[6], d[7], d[8]}}, shift);
  }
  const auto s =
      header.has("spacings") ? header.three_numbers("spacings", axes, first) : std::vector<double>(3, 1);
  return place_of({{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}}, shift);
}

// Whether the numbers are the last bytes, whatever is before them.
bool are_last(const VoxelHeader& header, bool raw) {
  bool last = false;
  for (const char* name : {"line skip", "lineskip", "byte skip", "byteskip"}) {
    const std::string skip = header.word(name, "0");
    const bool to_last = raw && skip == "-1" && std::string_view(name).starts_with("byte");
    if (skip != "0" && !to_last)
      fail_at(header.line(name), "skips lines or bytes before its numbers, which is not read");
    last |= to_last;
  }
  return last;
}

}  // namespace

bool is_nrrd(std::string_view bytes) {
  return bytes.starts_with("NRRD000");
}

VoxelImage parse_nrrd(std::string_view bytes, const ReadBeside& beside) {
  VoxelHeader header;
  std::string_view data = read_header_lines(bytes, [&](std::string_view text, std::uint64_t line) {
    if (text.empty()) return false;
    const std::size_t colon = text.find(':');
    if (text.front() == '#' || colon == std::string_view::npos) return true;
    if (colon + 1 < text.size() && text[colon + 1] == '=') return true;  // a key of somebody's own
    header.set(text.substr(0, colon), text.substr(colon + 1), line);
    return true;
  });
  std::optional<std::string> other;
  for (const char* name : {"data file", "datafile"})
    if (header.has(name)) other = read_numbers_beside(header.word(name), header.line(name), beside);
  VoxelImage image;
  std::vector<double> sizes = header.numbers("sizes");
  const std::size_t axes = sizes.size(), first = first_in_space(sizes);
  sizes.erase(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(first));
  image.size = sizes_of(sizes, header.line("sizes"));
  image.place = nrrd_place(header, axes, first);
  const std::size_t count = voxels_of(image.size);
  const base::NumberKind kind = nrrd_kind(header);
  const bool big = base::lower_case(header.word("endian")) == "big";
  const std::string encoding = base::lower_case(header.word("encoding", "raw"));
  if (are_last(header, encoding == "raw")) {
    const std::size_t given = other ? other->size() : data.size(), wanted = count * kind.bytes;
    if (given > wanted && other) other->erase(0, given - wanted);
    if (given > wanted && !other) data.remove_prefix(given - wanted);
  }
  const bool packed = encoding == "gz" || encoding == "gzip";
  if (packed) other = unpack(other ? *other : data);
  if (packed || encoding == "raw") {
    image.numbers = numbers_of(count, data, std::move(other), kind, big);
  } else if (encoding == "ascii" || encoding == "text" || encoding == "txt") {
    if (other) fail_at(0, "has its numbers in another file as text, which is not read");
    if (count > data.size())
      fail_at(0, std::to_string(count) + " voxels announced, but only " + std::to_string(data.size()) +
                     " bytes follow");
    TextWords words(data, static_cast<std::uint64_t>(std::count(
                              bytes.begin(), bytes.end() - static_cast<std::ptrdiff_t>(data.size()), '\n')) +
                              1);
    std::string values;
    values.reserve(count * sizeof(float));
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      base::append(values, static_cast<float>(parse_finite(word, words.line(), "value")));
    image.numbers = base::PackedNumbers(std::move(values), base::kNumberKind<float>);
    if (image.numbers.size() != count)
      fail_at(words.line(),
              std::to_string(image.numbers.size()) + " values for " + std::to_string(count) + " voxels");
  } else {
    fail_at(header.line("encoding"), "the encoding '" + encoding + "' is not read; write raw or gzip");
  }
  return image;
}

}  // namespace affskel::core
