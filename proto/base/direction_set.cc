#include "base/direction_set.h"

#include <charconv>
#include <stdexcept>
#include <system_error>

#include "base/quoted.h"

namespace affskel::base {
namespace {

using Kind = DirectionSetPart::Kind;

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

[[noreturn]] void fail(std::string_view part, std::string_view why) {
  throw std::invalid_argument(direction_set_error(part, why));
}

std::uint64_t parse_number(std::string_view text, std::string_view part, std::string_view why) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) fail(part, why);
  return value;
}

DirectionSetPart parse_part(std::string_view part) {
  const std::vector<std::string_view> words = split(part, ':');
  if (words[0] == "triangles" && words.size() == 1) return {};
  const bool sphere = words[0] == "sphere" && words.size() == 2;
  const bool random = words[0] == "random" && words.size() == 3;
  if (!sphere && !random) fail(part, "not a direction set");
  DirectionSetPart result;
  result.kind = sphere ? Kind::kSphere : Kind::kRandom;
  result.count = parse_number(words[1], part, "N is not a number");
  if (result.count == 0) fail(part, "N must be at least 1");
  if (random) result.seed = parse_number(words[2], part, "SEED must be 0 .. 2^64 - 1");
  return result;
}

}  // namespace

std::string DirectionSetPart::text() const {
  switch (kind) {
    case Kind::kTriangles:
      return "triangles";
    case Kind::kSphere:
      return "sphere:" + std::to_string(count);
    case Kind::kRandom:
      return "random:" + std::to_string(count) + ":" + std::to_string(seed);
  }
  throw std::logic_error("a kind of direction set without a name");
}

std::vector<DirectionSetPart> parse_direction_set(std::string_view text) {
  std::vector<DirectionSetPart> parts;
  for (const std::string_view part : split(text, '+')) parts.push_back(parse_part(part));
  return parts;
}

std::string direction_set_error(std::string_view part, std::string_view why) {
  return "directions " + quoted(part) + ": " + std::string(why) +
         "; expected triangles, sphere:N or random:N:SEED, joined by +";
}

}  // namespace affskel::base
