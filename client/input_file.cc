#include "client/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>

#include "client/error.h"
#include "client/exporters/format.h"
#include "client/importers/shape_file.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (fd_ >= 0) close(fd_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

ClientError too_large(const std::string& path, std::uint64_t max_bytes) {
  return {ExitCode::kLimit, "is larger than " + std::to_string(max_bytes) + " bytes", path};
}

[[noreturn]] void unreadable(const std::string& path) {
  throw ClientError(ExitCode::kBadInput, "cannot read: " + std::system_category().message(errno), path);
}

// What the file announces is taken in one piece; what comes unannounced in pieces that double, up to one byte
// more than is allowed.
std::string read_all(int fd, const std::string& path, std::uint64_t announced, std::uint64_t max_bytes) {
  constexpr std::uint64_t kLeastStep = 1 << 16;
  std::string bytes;
  std::uint64_t size = 0;
  for (std::uint64_t room = std::max(announced + 1, kLeastStep);;) {
    room = std::min(room, max_bytes + 1);
    bytes.resize(room);
    const ssize_t got = read(fd, bytes.data() + size, room - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) unreadable(path);
    if (got == 0) break;
    size += static_cast<std::uint64_t>(got);
    if (size > max_bytes) throw too_large(path, max_bytes);
    if (size == room) room = size + std::max(size, kLeastStep);
  }
  bytes.resize(size);
  return bytes;
}

// What OFF text is not is told by the name, or by the first bytes of a file that is named after nothing
// known.
std::string format_of(const std::string& path, std::string_view bytes) {
  const std::string extension = lower_extension(path);
  for (const FileFormat format : {FileFormat::kPly, FileFormat::kObj, FileFormat::kStl, FileFormat::kVtp}) {
    if (extension == extension_of(format)) return extension.substr(1);
  }
  return extension != extension_of(FileFormat::kOff) && bytes.starts_with("ply") ? "ply" : "off";
}

// The server stores OFF text: what the file holds beside its surface (colours, normals) has no place there.
void convert(InputFile& input) {
  ShapeFile shape = parse_shape(input.path, input.bytes);
  if (!shape.is_surface()) {
    throw ClientError(ExitCode::kBadInput, "has no triangles; a mesh that bounds a solid is wanted",
                      input.path);
  }
  input.off = std::move(shape.off);
  input.bytes = core::write_off(input.off.mesh);
}

}  // namespace

ClientError out_of_memory(const std::string& path) {
  return {ExitCode::kLimit, "not enough memory to read it", path};
}

std::string read_file(const std::string& path, std::uint64_t max_bytes) {
  const OpenFile file(path);
  if (file.fd() < 0) unreadable(path);
  struct stat info {};
  if (fstat(file.fd(), &info) != 0) unreadable(path);
  if (S_ISREG(info.st_mode) && static_cast<std::uint64_t>(info.st_size) > max_bytes)
    throw too_large(path, max_bytes);
  const std::uint64_t announced = S_ISREG(info.st_mode) ? static_cast<std::uint64_t>(info.st_size) : 0;
  try {
    return read_all(file.fd(), path, announced, max_bytes);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
  }
}

core::OffMesh parse_mesh(const std::string& bytes, const std::string& path) {
  try {
    return core::read_off(bytes);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, path);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
  }
}

InputFile read_input(const std::string& path) {
  InputFile input;
  input.path = path;
  input.bytes = read_file(path);
  input.format = format_of(path, input.bytes);
  input.file_bytes = input.bytes.size();
  input.file_sha256 = wire::sha256_hex(input.bytes);
  if (input.converted()) {
    convert(input);
  } else {
    input.off = parse_mesh(input.bytes, path);
  }
  return input;
}

void tell_conversion(const InputFile& input, Console& console) {
  if (!input.converted()) return;
  console.note(input.path + ": read as " + input.format + " and submitted as OFF text, " +
               std::to_string(input.off.mesh.points.size()) + " vertices and " +
               std::to_string(input.off.mesh.triangles.size()) + " triangles; fetch mesh gives that text");
}

core::Solid check_solid(const InputFile& input, bool repair) {
  core::SolidOptions options;
  options.repair = repair;
  try {
    return core::make_solid(input.off.mesh, options, input.off.vertex_line, input.off.triangle_line);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, input.path);
  }
}

void tell_notes(const core::Solid& solid, const InputFile& input, Console& console) {
  for (const core::MeshNote& note : solid.notes) {
    const bool repaired = note.severity == core::MeshNote::Severity::kRepaired;
    const std::string text = input.path + ": " + (repaired ? "repaired: " : "") + note.message;
    if (repaired) {
      console.note(text);
    } else {
      console.warning(text);
    }
  }
}

}  // namespace affskel::client
