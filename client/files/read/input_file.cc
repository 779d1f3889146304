#include "client/files/read/input_file.h"

#include <new>
#include <utility>

#include "client/base/error.h"
#include "client/files/format.h"
#include "client/files/read/read_file.h"
#include "core/files/read/parse_shape.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

// The server stores OFF text: what the file holds beside its surface (colours, normals) has no place there.
void parse(InputFile& input) {
  core::MeshFile file = core::parse_mesh_file(lower_extension(input.path), input.bytes);
  input.format = extension_of(file.format).substr(1);
  input.off = std::move(file.off);
  if (input.converted()) input.bytes = core::write_off(input.off.mesh);
}

}  // namespace

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
  input.file_bytes = input.bytes.size();
  input.file_sha256 = wire::sha256_hex(input.bytes);
  try {
    parse(input);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, path);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
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
