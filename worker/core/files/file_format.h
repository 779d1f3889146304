#pragma once

#include <span>
#include <string_view>

namespace affskel::core {

enum class FileFormat {
  kCsv,
  kDat,
  kVti,
  kVts,
  kVtkHdf,
  kHdf,
  kPly,
  kOff,
  kXyz,
  kObj,
  kStl,
  kVtp,
  kPng,
  kSvg,
  kHtml,
  kJson,
  kGraphMl,
  kSwc,
  kGlb
};

/// What can be written as which formats.
std::span<const FileFormat> field_formats();     // csv dat vti vts vtkhdf hdf
std::span<const FileFormat> skeleton_formats();  // csv ply off xyz vtp
std::span<const FileFormat> surface_formats();   // off ply obj stl vtp

std::span<const FileFormat> curve_formats();  // vtp obj ply json graphml swc glb

/// With the dot, e.g. ".csv".
std::string_view extension_of(FileFormat format);

}  // namespace affskel::core
