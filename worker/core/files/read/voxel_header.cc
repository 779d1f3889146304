#include "core/files/read/voxel_header.h"

#include <algorithm>

#include "base/lower_case.h"
#include "core/text/text_rows.h"

namespace affskel::core {

void VoxelHeader::set(std::string_view name, std::string_view value, std::uint64_t line) {
  fields_[base::lower_case(without_blanks(name))] = {std::string(without_blanks(value)), line};
}

std::string VoxelHeader::word(const char* name, const char* usual) const {
  const auto found = fields_.find(name);
  return found == fields_.end() ? usual : found->second.value;
}

std::uint64_t VoxelHeader::line(const char* name) const {
  const auto found = fields_.find(name);
  return found == fields_.end() ? 0 : found->second.line;
}

std::vector<std::string> VoxelHeader::words(const char* name) const {
  std::string text = word(name);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  TextRows row(text);
  if (!row.next()) return {};
  return {row.words().begin(), row.words().end()};
}

std::vector<double> VoxelHeader::numbers(const char* name) const {
  std::vector<double> found;
  for (const std::string& one : words(name)) found.push_back(parse_finite(one, line(name), name));
  return found;
}

std::vector<double> VoxelHeader::three_numbers(const char* name, std::size_t axes, std::size_t first) const {
  const std::vector<std::string> all = words(name);
  if (all.size() != 3 && all.size() != axes)
    fail_at(line(name), std::string(name) + " needs " + std::to_string(axes) + " numbers");
  std::vector<double> found;
  if (all.size() == 3) first = 0;
  for (std::size_t i = 0; i < 3; ++i) found.push_back(parse_finite(all[first + i], line(name), name));
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
