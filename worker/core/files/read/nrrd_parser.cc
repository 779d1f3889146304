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

// Sizes along the axes in space, and the steps along these.
struct Space {
  std::vector<double> sizes;
  std::vector<Vec3> steps;
};

// Of each axis the step, or none where it is of the values at a place.
std::vector<std::optional<Vec3>> directions_of(const VoxelHeader& header) {
  constexpr const char* kName = "space directions";
  const std::vector<std::string> words = header.words(kName);
  const std::uint64_t line = header.line(kName);
  std::vector<std::optional<Vec3>> found;
  for (std::size_t i = 0; i < words.size(); i += found.back() ? 3 : 1) {
    const auto number = [&](std::size_t k) { return parse_finite(words[i + k], line, kName); };
    if (words[i] == "none") {
      found.emplace_back();
    } else if (words.size() - i >= 3) {
      found.emplace_back(Vec3{number(0), number(1), number(2)});
    } else {
      fail_at(line, "space directions ends within a vector");
    }
  }
  return found;
}

// What has no direction is no axis in space, and has one item.
Space space_by_directions(const VoxelHeader& header, const std::vector<double>& sizes) {
  const std::vector<std::optional<Vec3>> directions = directions_of(header);
  const std::uint64_t line = header.line("space directions");
  if (directions.size() != sizes.size()) {
    sizes_of(sizes, header.line("sizes"));  // which may be what is wrong
    fail_at(line, "space directions needs a vector or none for each of the " + std::to_string(sizes.size()) +
                      " axes");
  }
  Space space;
  for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
    if (directions[axis]) {
      space.sizes.push_back(sizes[axis]);
      space.steps.push_back(*directions[axis]);
    } else if (sizes[axis] != 1) {
      fail_at(header.line("sizes"), "the image has more than one value at a place");
    }
  }
  if (space.steps.size() != 3) fail_at(line, "space directions needs three vectors");
  return space;
}

// Without directions the sizes tell: before the axes in space there may be that of the values at a place, a single one.
Space space_by_sizes(const VoxelHeader& header, std::vector<double> sizes) {
  const std::size_t axes = sizes.size(), first = axes == 4 && sizes[0] == 1 && sizes[3] != 1 ? 1 : 0;
  sizes.erase(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(first));
  const auto s =
      header.has("spacings") ? header.three_numbers("spacings", axes, first) : std::vector<double>(3, 1);
  return {std::move(sizes), {{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}}};
}

void take_space(const VoxelHeader& header, VoxelImage& image) {
  const std::vector<double> sizes = header.numbers("sizes");
  const bool directed = header.has("space directions");
  const Space space = directed ? space_by_directions(header, sizes) : space_by_sizes(header, sizes);
  image.size = sizes_of(space.sizes, header.line("sizes"));
  const std::vector<double> origin =
      header.has("space origin") ? header.numbers("space origin", 3) : std::vector<double>(3, 0);
  image.place = place_of(space.steps, {origin[0], origin[1], origin[2]});
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
  take_space(header, image);
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
