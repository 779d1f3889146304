#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/packed_numbers.h"

namespace affskel::core {

/// One array of a VTK XML file, as its tag describes it.
struct VtkArray {
  std::string name, type, format, offset;
  std::uint64_t components = 1;
  std::string_view text;   ///< between the tags
  std::uint64_t line = 0;  ///< of its tag
};

/// What holds for all arrays of a VTK XML file.
struct VtkEncoding {
  bool big_endian = false;
  bool long_headers = false;  ///< lengths have 64 bits, not 32
  std::string compressor;     ///< empty: none
  bool base64 = false;        ///< the appended data are; otherwise raw
  std::string_view appended;  ///< behind the underscore
};

/// Whether arrays of this type hold numbers, and whether whole ones.
bool is_vtk_number(std::string_view type);
bool is_vtk_whole(std::string_view type);

/// The numbers of an array, all components one point after the other; those that are appended raw are seen in the
/// file's bytes, which must outlive them.
/// @throws CoreError kBadInput with the line of its tag, also for compressed data, which are not read.
base::PackedNumbers vtk_numbers(const VtkArray& array, const VtkEncoding& encoding);

}  // namespace affskel::core
