#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace affskel::client {

/// The arrays of a page, one after the other, each at a multiple of 4 bytes; a directory for each model.  Read by
/// client/view/web/decode.js.
class PageArrays {
 public:
  void begin_model() { directory_ = nlohmann::ordered_json::object(); }

  /// @param type u16, u32, f32 or i8, as wide as Number.
  template <typename Number>
  void add(const char* name, const char* type, const std::vector<Number>& values) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    directory_[name] = {type, bytes_.size(), values.size()};
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
  }

  /// Of the model: of each array its type, where it begins, bytes, and how many numbers it has.
  const nlohmann::ordered_json& directory() const { return directory_; }
  const std::string& bytes() const { return bytes_; }

 private:
  nlohmann::ordered_json directory_;
  std::string bytes_;
};

}  // namespace affskel::client
