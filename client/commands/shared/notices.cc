#include "client/commands/shared/notices.h"

#include <algorithm>

namespace affskel::client {
namespace {

// Options are called as the protocol's fields, but for their dashes.
std::string option_text(const v1::Setting& setting) {
  std::string name = setting.name();
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name + " " + setting.value();
}

std::string text_of(const Notice& notice) {
  std::string text = (notice.file.empty() ? "" : notice.file + ": ") + notice.message;
  std::string options;
  for (const v1::Setting& setting : notice.to_try)
    options += (options.empty() ? "" : " or ") + option_text(setting);
  if (options.empty()) return text;
  return text + (text.ends_with('.') ? " Try " : "; try ") + options;
}

}  // namespace

void say(Console& console, const Notice& notice) {
  if (notice.kind == Notice::Kind::kWarning) {
    console.warning(text_of(notice));
  } else {
    console.note(text_of(notice));
  }
}

void say(Console& console, const Notices& notices) {
  for (const Notice& notice : notices) say(console, notice);
}

}  // namespace affskel::client
