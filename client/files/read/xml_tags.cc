#include "client/files/read/xml_tags.h"

#include <algorithm>
#include <array>

#include "client/files/read/shape_parsers.h"

namespace affskel::client {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string without_entities(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string plain;
  while (!text.empty()) {
    const auto entity = std::find_if(kEntities.begin(), kEntities.end(),
                                     [&](const auto& e) { return text.starts_with(e.first); });
    const bool found = entity != kEntities.end();
    plain.push_back(found ? entity->second : text.front());
    text.remove_prefix(found ? entity->first.size() : 1);
  }
  return plain;
}

}  // namespace

void XmlTags::move_to(std::size_t place) {
  line_ += static_cast<std::uint64_t>(std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
                                                 bytes_.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
  begin_ = place;
}

std::size_t XmlTags::closing_bracket() const {
  char quote = 0;
  for (std::size_t i = begin_; i < bytes_.size(); ++i) {
    const char c = bytes_[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return i;
    }
  }
  fail_at(line_, "a tag of XML does not end");
}

bool XmlTags::next() {
  text_before_.clear();
  for (;;) {
    const std::size_t start = bytes_.find('<', end_);
    if (start == std::string_view::npos) return false;
    text_before_.push_back(bytes_.substr(end_, start - end_));
    move_to(start);
    const std::string_view rest = bytes_.substr(start);
    if (rest.starts_with("<!--")) {
      const std::size_t stop = rest.find("-->");
      if (stop == std::string_view::npos) fail_at(line_, "a comment of XML does not end");
      end_ = start + stop + 3;
      continue;
    }
    if (rest.starts_with("<![CDATA[")) fail_at(line_, "CDATA sections are not read");
    end_ = closing_bracket() + 1;
    if (rest.starts_with("<?") || rest.starts_with("<!")) continue;

    std::string_view text = bytes_.substr(begin_ + 1, end_ - begin_ - 2);
    opens_ = !text.starts_with('/');
    closes_ = !opens_ || text.ends_with('/');
    if (!opens_) text.remove_prefix(1);
    if (opens_ && closes_) text.remove_suffix(1);
    name_ = text.substr(0, text.find_first_of(kBlanks));
    read_attributes(text.substr(name_.size()));
    return true;
  }
}

void XmlTags::read_attributes(std::string_view text) {
  attributes_.clear();
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (text.empty()) return;
    const std::size_t equals = text.find('=');
    const std::size_t open =
        text.find_first_not_of(kBlanks, equals == std::string_view::npos ? equals : equals + 1);
    const bool quoted = open != std::string_view::npos && (text[open] == '"' || text[open] == '\'');
    const std::size_t close = quoted ? text.find(text[open], open + 1) : std::string_view::npos;
    if (close == std::string_view::npos) fail_at(line_, "expected NAME=\"VALUE\" in a tag of XML");
    // Blanks are looked for in front of the = only, lest a long tag without any take quadratic time.
    const std::string_view name = text.substr(0, equals);
    attributes_.emplace_back(name.substr(0, name.find_first_of(kBlanks)),
                             text.substr(open + 1, close - open - 1));
    text.remove_prefix(close + 1);
  }
}

std::string XmlTags::attribute(std::string_view name) const {
  for (const auto& [known, value] : attributes_) {
    if (known == name) return without_entities(value);
  }
  return "";
}

}  // namespace affskel::client
