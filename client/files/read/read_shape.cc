#include "client/files/read/read_shape.h"

#include <new>

#include "client/base/error.h"
#include "client/files/format.h"
#include "client/files/read/read_file.h"
#include "core/files/read/parse_shape.h"
#include "core/files/read/unpack.h"

namespace affskel::client {

ShapeFile read_shape(const std::string& path) {
  if (path == "-") return parse_shape("stdin", read_standard_input("stdin"));
  return parse_shape(path, read_file(path));
}

ShapeFile parse_shape(const std::string& path, std::string_view bytes) {
  try {
    std::string unpacked;
    if (!core::compression_of(bytes).empty()) bytes = unpacked = core::unpack(bytes);
    ShapeFile file = core::parse_shape(lower_extension(core::unpacked_name(path)), bytes);
    file.path = path;
    return file;
  } catch (const core::CoreError& error) {
    throw error_from_core(error, path);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
  }
}

}  // namespace affskel::client
