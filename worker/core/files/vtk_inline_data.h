#pragma once

#include <string>
#include <string_view>

namespace affskel::core {

/// The bytes of an array as they stand inline in a VTK XML file with header_type UInt64: base64 of their
/// number and of themselves.
std::string vtk_inline(std::string_view bytes);

/// The same compressed, for files with the compressor vtkZLibDataCompressor: base64 of the numbers of blocks,
/// of bytes per block, of bytes in a last block that is not full, and of compressed bytes block by block;
/// then base64 of the blocks.  @throws CoreError kLimit when zlib finds no memory.
std::string vtk_inline_compressed(std::string_view bytes);

}  // namespace affskel::core
