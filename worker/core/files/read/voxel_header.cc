#include "core/files/read/voxel_header.h"

#include <algorithm>
#include <cctype>

#include "core/text/text_rows.h"

namespace affskel::core {

std::string lower_case(std::string_view text) {
  std::string made(text);
  std::transform(made.begin(), made.end(), made.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return made;
}

void VoxelHeader::set(std::string_view name, std::string_view value, std::uint64_t line) {
  fields_[lower_case(without_blanks(name))] = {std::string(without_blanks(value)), line};
}

std::string VoxelHeader::word(const char* name, const char* usual) const {
  const auto found = fields_.find(name);
  return found == fields_.end() ? usual : found->second.value;
}

std::uint64_t VoxelHeader::line(const char* name) const {
  const auto found = fields_.find(name);
  return found == fields_.end() ? 0 : found->second.line;
}

std::vector<double> VoxelHeader::numbers(const char* name) const {
  std::string text = word(name);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::vector<double> found;
  TextRows row(text);
  if (row.next())
    for (const std::string_view one : row.words()) found.push_back(parse_finite(one, line(name), name));
  return found;
}

std::vector<double> VoxelHeader::numbers(const char* name, std::size_t count) const {
  const std::vector<double> found = numbers(name);
  if (found.size() != count)
    fail_at(line(name), std::string(name) + " needs " + std::to_string(count) + " numbers");
  return found;
}

std::string_view read_header_lines(std::string_view bytes,
                                   const std::function<bool(std::string_view, std::uint64_t)>& take) {
  std::uint64_t line = 0;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    if (end > 65536 || line == 10000) fail_at(line + 1, "the header does not end");
    const bool more = take(without_blanks(bytes.substr(0, end)), ++line);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    if (!more) return bytes;
  }
  return bytes;
}

}  // namespace affskel::core
