#pragma once

#include <cstdint>
#include <string>

#include "client/base/error.h"
#include "client/base/notice.h"
#include "core/solid/solid.h"
#include "core/text/off_file.h"

namespace affskel::client {

/// A mesh file that was read and parsed.
struct InputFile {
  std::string path;
  std::string bytes;           ///< OFF text: the file's own bytes, or what was made of another format
  core::OffMesh off;           ///< with the lines of the file, where it is text
  std::string format = "off";  ///< of the file: off, ply, obj, stl or vtp
  std::uint64_t file_bytes = 0;
  std::string file_sha256;  ///< hexadecimal
  bool converted() const { return format != "off"; }
};

/// Reads and parses a mesh: .ply, .obj, .stl and .vtp as read_shape does, after which `bytes` are the OFF
/// text of their surface; everything else as OFF text, kept byte for byte.
/// @throws ClientError as read_file, and kBadInput with the line for malformed text.
InputFile read_input(const std::string& path);

/// The same of what a command line names: "-" is standard input, whose format its content tells (see
/// core::extension_of_content) and whose path becomes "stdin".
InputFile read_named_input(const std::string& name);

/// Parses bytes that came from `path`, or from the server when `path` names no file.
core::OffMesh parse_mesh(const std::string& bytes, const std::string& path);

/// Checks that the mesh bounds a solid.
/// @param context asked whether to stop; may be null.
/// @throws ClientError kBadInput with the place, kCancelled when the context asks to stop.
core::Solid check_solid(const InputFile& input, bool repair, core::ExecutionContext* context = nullptr);

/// What of a file was passed over: "1204 rows of vn (normals), 2 rows of g (groups)"; empty when nothing was.
std::string passed_over_text(const core::OffMesh& off);

/// That the file is not what is submitted, and what of it was passed over.
Notices conversion_notices(const InputFile& input);

/// The notes of the solid: repairs as notes, oddities as warnings.
Notices solid_notices(const core::Solid& solid, const InputFile& input);

}  // namespace affskel::client
