#include "client/web/private_folder.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "client/base/error.h"

namespace affskel::client {

namespace fs = std::filesystem;

PrivateFolder::PrivateFolder() {
  std::error_code error;
  const fs::path place = fs::temp_directory_path(error);
  if (error) throw error_from_errno(error.value(), "cannot use the folder for temporary files", "$TMPDIR");
  std::string name = (place / "affskel-web-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw error_from_errno(errno, "cannot make a folder in", place);
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path PrivateFolder::new_path(const std::string& extension) {
  return path_ / (std::to_string(++given_) + extension);
}

OwnedFile::~OwnedFile() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

std::uint64_t OwnedFile::bytes() const {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path_, error);
  return error ? 0 : size;
}

}  // namespace affskel::client
