#include "client/text/nearest_word.h"

#include <algorithm>
#include <utility>

namespace affskel::client {
namespace {

std::string_view without_dashes(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

// Row by row of the table of distances between beginnings of `a` and of `b`.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({replaced, last[j] + 1, now[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before = std::exchange(last, now);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  const std::string_view typed = without_dashes(word);
  const std::size_t most = std::max<std::size_t>(1, typed.size() / 3);
  std::size_t least = most + 1;
  std::string nearest;
  for (const std::string& candidate : known) {
    const std::string_view name = without_dashes(candidate);
    // An option of one letter is near to all others.
    if (name.size() < 2 || typed.size() < 2) continue;
    const std::size_t far = name.starts_with(typed) ? 1 : distance(typed, name);
    if (far >= least) continue;
    least = far;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace affskel::client
