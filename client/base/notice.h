#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

/// Something to know besides a result: a value, which each face (command line, page, HTTP) words as it likes.
struct Notice {
  enum class Kind {
    kNote,     ///< what was done
    kWarning,  ///< what is likely not as the user wants it
  };
  Kind kind = Kind::kNote;
  std::string code;                      ///< for programs, e.g. "EMPTY_SKELETON"
  std::string message;                   ///< for people; names no option of any face
  std::string file = {};                 ///< that it is about; empty = none
  std::vector<v1::Setting> to_try = {};  ///< settings that would help, the most promising first
};
using Notices = std::vector<Notice>;

inline void append(Notices& all, Notices more) {
  for (Notice& notice : more) all.push_back(std::move(notice));
}

/// Hears of what goes on while something is worked on, from any thread.
using Listener = std::function<void(const Notice&)>;

inline Notice note(std::string code, std::string message, std::string file = {}) {
  return {Notice::Kind::kNote, std::move(code), std::move(message), std::move(file)};
}
inline Notice warning(std::string code, std::string message, std::string file = {}) {
  return {Notice::Kind::kWarning, std::move(code), std::move(message), std::move(file)};
}

}  // namespace affskel::client
