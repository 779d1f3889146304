#include "field_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "core/base/error.h"

namespace affskel::worker {
namespace {

namespace fs = std::filesystem;

bool ends_with(const std::string& text, const std::string& tail) {
  return text.size() >= tail.size() && text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

// What open(2) would have given a new file.
mode_t default_mode() {
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

// The file while it is written; without commit() it leaves nothing behind.
class Output {
 public:
  explicit Output(const std::string& path) : path_(path), target_(path) {
    std::error_code none;
    const fs::file_status link = fs::symlink_status(path, none), status = fs::status(path, none);
    if (fs::exists(link) && !fs::is_regular_file(status)) {
      file_ = std::fopen(path.c_str(), "we");
    } else {
      open_temporary(fs::exists(status));
    }
    if (file_ == nullptr) throw failure("cannot be opened for writing");
  }

  ~Output() {
    if (file_ != nullptr) std::fclose(file_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  std::FILE* file() const { return file_; }

  void commit() {
    if (std::fflush(file_) != 0 || std::ferror(file_) != 0) throw failure("writing failed");
    if (temporary_.empty()) return;
    if (fsync(fileno(file_)) != 0) throw failure("writing failed");
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) throw failure("cannot be renamed into place");
    temporary_.clear();
  }

 private:
  void open_temporary(bool exists) {
    struct stat info {};
    if (exists) target_ = fs::canonical(path_);
    if (exists && stat(target_.c_str(), &info) != 0) throw failure("cannot be looked at");
    // Not after the target: its name may be as long as names can be.
    std::string name = target_.parent_path() / ".affskel.XXXXXX";
    const int fd = mkostemp(name.data(), O_CLOEXEC);
    if (fd < 0) return;
    temporary_ = name;
    if (fchmod(fd, exists ? info.st_mode & 07777 : default_mode()) == 0) file_ = fdopen(fd, "w");
    if (file_ == nullptr) close(fd);
  }

  std::system_error failure(const char* what) const {
    return {errno, std::generic_category(), path_ + ": " + what};
  }

  std::string path_;
  fs::path target_;
  std::string temporary_;  // empty when written to directly, and once renamed
  std::FILE* file_ = nullptr;
};

}  // namespace

void check_field_file(const std::string& path) {
  if (ends_with(path, ".csv") || ends_with(path, ".dat")) return;
  throw core::CoreError(core::CoreError::Code::kBadInput,
                        "output " + path + ": the extension must be .csv or .dat");
}

void write_field_file(const std::string& path, const core::Solid& solid, const core::Lattice& lattice,
                      const core::DirectionSet& directions, const core::ErosionField& field) {
  Output output(path);
  const bool csv = ends_with(path, ".csv");
  if (csv) std::fputs("x,y,z,E,nx,ny,nz,direction\n", output.file());
  const core::SamplePlaces places(solid, lattice);
  const double volume_unit = std::ldexp(1.0, 3 * solid.exponent);
  for (const core::LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const core::Vec3 x = places.at(run.start[0], run.start[1], run.start[2] + n);
      const core::FieldValue value = field.value(run.first + n);
      const core::Vec3& d = directions[value.direction];
      const double erosion = value.erosion * volume_unit;
      if (csv) {
        std::fprintf(output.file(), "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%u\n", x.x, x.y, x.z, erosion,
                     d.x, d.y, d.z, value.direction);
      } else {
        std::fprintf(output.file(), "%.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", x.x, x.y, x.z, erosion,
                     d.x, d.y, d.z);
      }
    }
  }
  output.commit();
}

}  // namespace affskel::worker
