#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "client/base/error.h"
#include "client/base/notice.h"
#include "core/files/read/parse_shape.h"
#include "core/solid/solid.h"
#include "core/text/off_file.h"

namespace affskel::client {

/// A mesh file that was read and parsed.
struct InputFile {
  std::string path;
  std::string bytes;           ///< of OFF text, unpacked; of another format none, see OffText
  core::OffMesh off;           ///< with the lines of the file, where it is text
  std::string format = "off";  ///< of the file, see core::MeshFile
  bool off_text = true;        ///< of the file, unpacked
  std::string told;            ///< of an image of voxels: how its surface was made
  std::string packed;          ///< how the file is compressed, see core::compression_of
  std::uint64_t file_bytes = 0;
  std::string file_sha256;  ///< hexadecimal
  bool converted() const { return !off_text || !packed.empty(); }
};

/// The OFF text that is submitted of a file: its own, or that of its surface, made here.
class OffText {
 public:
  /// @param input must outlive this.
  explicit OffText(const InputFile& input)
      : input_(input), made_(input.off_text ? std::string() : core::write_off(input.off.mesh)) {}
  std::string_view view() const { return input_.off_text ? input_.bytes : made_; }

 private:
  const InputFile& input_;
  std::string made_;
};

/// Reads and parses a mesh, see core::parse_mesh_file, unpacked where it is compressed.  OFF text is kept byte for
/// byte.
/// @throws ClientError as read_file, and kBadInput with the line for malformed text.
InputFile read_input(const std::string& path, const core::MeshFileOptions& options = {});

/// The same of what a command line names, with the numbers that a header has in a file beside it; "-" is standard input,
/// whose path becomes "stdin".
InputFile read_named_input(const std::string& name, const core::MeshFileOptions& options = {});

/// What a job of a file is called: "body" of "scans/body.off.gz".
std::string job_name(const std::filesystem::path& file);

/// Parses bytes that came from `path`, or from the server when `path` names no file.
core::OffMesh parse_mesh(const std::string& bytes, const std::string& path);

/// Checks that the mesh bounds a solid.
/// @param context asked whether to stop; may be null.
/// @throws ClientError kBadInput with the place, kCancelled when the context asks to stop.
core::Solid check_solid(const InputFile& input, bool repair, core::ExecutionContext* context = nullptr);

/// What of a file was passed over: "1204 rows of vn (normals), 2 rows of g (groups)"; empty when nothing was.
std::string passed_over_text(const core::OffMesh& off);

/// How far faces with more than three sides are from being plane, and what that does to the volume; empty where it does
/// next to nothing.
std::string uneven_text(const core::OffMesh& off, double volume);

/// That the file is not what is submitted (CONVERTED, UNPACKED), and what of it was passed over or is to be known.
Notices conversion_notices(const InputFile& input);

/// The notes of the solid: repairs as notes, oddities as warnings.
Notices solid_notices(const core::Solid& solid, const InputFile& input);

}  // namespace affskel::client
