#include "core/files/vtk_arrays.h"

#include <string_view>

namespace affskel::core {
namespace {

constexpr std::string_view kNormal = "normal";

// Not "normals", which is another array.
bool is_normal(const std::string& array) {
  return array == kNormal || array.starts_with(std::string(kNormal) + "_");
}

}  // namespace

std::vector<std::string> columns_of_array(const std::string& array, std::size_t components) {
  if (components == 1) return {array};
  std::vector<std::string> names;
  for (std::size_t c = 0; c < components; ++c) {
    if (components != 3) {
      names.push_back(array + "_" + std::to_string(c));
    } else if (is_normal(array)) {
      names.push_back(std::string("n") + "xyz"[c] + array.substr(kNormal.size()));
    } else {
      names.push_back(array + "_" + "xyz"[c]);
    }
  }
  return names;
}

std::string array_of_columns(const std::string& x, const std::string& y, const std::string& z) {
  std::vector<std::string> candidates;
  if (x.starts_with("nx")) candidates.push_back(std::string(kNormal) + x.substr(2));
  if (x.size() > 2 && x.ends_with("_x")) candidates.push_back(x.substr(0, x.size() - 2));
  for (const std::string& array : candidates) {
    if (columns_of_array(array, 3) == std::vector<std::string>{x, y, z}) return array;
  }
  return "";
}

}  // namespace affskel::core
