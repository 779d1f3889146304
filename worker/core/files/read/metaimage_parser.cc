// MetaImage, see ITK's documentation of MetaIO.
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/lower_case.h"
#include "core/files/read/unpack.h"
#include "core/files/read/voxel_header.h"
#include "core/files/read/voxel_numbers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

// As MetaIO has it.
bool says_true(const VoxelHeader& header, const char* name, bool usual = false) {
  const std::string word = base::lower_case(header.word(name));
  return word.empty() ? usual : word.front() == 't' || word.front() == '1';
}

// @param axes of the image; those behind the third are of one item.
AffineMap metaimage_place(const VoxelHeader& header, std::size_t axes) {
  const char* spacing_name = header.has("elementspacing") ? "elementspacing" : "elementsize";
  const auto s =
      header.has(spacing_name) ? header.three_numbers(spacing_name, axes) : std::vector<double>(3, 1);
  std::vector<double> o(3, 0);
  for (const char* name : {"offset", "origin", "position"})
    if (header.has(name)) o = header.three_numbers(name, axes);
  std::vector<Vec3> steps{{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}};
  for (const char* name : {"transformmatrix", "rotation", "orientation"}) {
    if (!header.has(name)) continue;
    std::vector<double> m = header.numbers(name);  // a row per axis
    const std::size_t width = m.size() == 9 ? 3 : axes;
    if (m.size() != width * width) m = header.numbers(name, 9);
    for (std::size_t a = 0; a < 3; ++a)
      steps[a] = s[a] * Vec3{m[a * width], m[a * width + 1], m[a * width + 2]};
  }
  return place_of(steps, {o[0], o[1], o[2]});
}

}  // namespace

bool is_metaimage(std::string_view bytes) {
  const std::string head = base::lower_case(bytes.substr(0, 4096));
  return (head.starts_with("objecttype") || head.starts_with("ndims") || head.starts_with("comment")) &&
         head.find("dimsize") != std::string::npos;
}

VoxelImage parse_metaimage(std::string_view bytes, const ReadBeside& beside) {
  static const std::map<std::string, base::NumberKind> kTypes = {
      {"met_char", base::kNumberKind<std::int8_t>},
      {"met_uchar", base::kNumberKind<std::uint8_t>},
      {"met_short", base::kNumberKind<std::int16_t>},
      {"met_ushort", base::kNumberKind<std::uint16_t>},
      {"met_int", base::kNumberKind<std::int32_t>},
      {"met_uint", base::kNumberKind<std::uint32_t>},
      {"met_long", base::kNumberKind<std::int32_t>},  // of four bytes in MetaIO, whatever the machine
      {"met_ulong", base::kNumberKind<std::uint32_t>},
      {"met_long_long", base::kNumberKind<std::int64_t>},
      {"met_ulong_long", base::kNumberKind<std::uint64_t>},
      {"met_float", base::kNumberKind<float>},
      {"met_double", base::kNumberKind<double>}};
  VoxelHeader header;
  std::string_view data = read_header_lines(bytes, [&](std::string_view text, std::uint64_t line) {
    const std::size_t sign = text.find('=');
    if (sign == std::string_view::npos) return true;
    header.set(text.substr(0, sign), text.substr(sign + 1), line);
    return base::lower_case(without_blanks(text.substr(0, sign))) != "elementdatafile";
  });
  if (!header.has("elementdatafile")) fail_at(0, "the header does not end");
  if (!says_true(header, "binarydata", true))
    fail_at(header.line("binarydata"),
            "has its numbers as text, which is not read; write them with BinaryData = True");
  if (header.word("headersize", "0") != "0")
    fail_at(header.line("headersize"), "skips bytes before its numbers, which is not read");
  std::optional<std::string> other;
  if (const std::string name = header.word("elementdatafile"); base::lower_case(name) != "local") {
    other = read_numbers_beside(name, header.line("elementdatafile"), beside);
  }
  VoxelImage image;
  const std::vector<double> sizes = header.numbers("dimsize");
  image.size = sizes_of(sizes, header.line("dimsize"));
  if (header.has("elementnumberofchannels") && header.word("elementnumberofchannels") != "1")
    fail_at(header.line("elementnumberofchannels"), "the image has more than one value at a place");
  const auto kind = kTypes.find(base::lower_case(header.word("elementtype")));
  if (kind == kTypes.end())
    fail_at(header.line("elementtype"), "unknown type of values '" + header.word("elementtype") + "'");
  image.place = metaimage_place(header, sizes.size());
  const bool big = says_true(header, "elementbyteordermsb", says_true(header, "binarydatabyteordermsb"));
  const std::size_t count = voxels_of(image.size);
  if (says_true(header, "compresseddata")) other = unpack(other ? *other : data);
  image.numbers = numbers_of(count, data, std::move(other), kind->second, big);
  return image;
}

}  // namespace affskel::core
