#include "core/files/file_format.h"

#include <array>
#include <cstddef>

namespace affskel::core {

std::span<const FileFormat> field_formats() {
  static constexpr std::array kFormats = {FileFormat::kCsv, FileFormat::kDat,    FileFormat::kVti,
                                          FileFormat::kVts, FileFormat::kVtkHdf, FileFormat::kHdf};
  return kFormats;
}

std::span<const FileFormat> skeleton_formats() {
  static constexpr std::array kFormats = {FileFormat::kCsv, FileFormat::kPly, FileFormat::kOff,
                                          FileFormat::kXyz, FileFormat::kVtp};
  return kFormats;
}

std::span<const FileFormat> surface_formats() {
  static constexpr std::array kFormats = {FileFormat::kOff, FileFormat::kPly, FileFormat::kObj,
                                          FileFormat::kStl, FileFormat::kVtp};
  return kFormats;
}

std::span<const FileFormat> curve_formats() {
  static constexpr std::array kFormats = {FileFormat::kVtp,  FileFormat::kObj,     FileFormat::kPly,
                                          FileFormat::kJson, FileFormat::kGraphMl, FileFormat::kSwc,
                                          FileFormat::kGlb};
  return kFormats;
}

std::string_view extension_of(FileFormat format) {
  constexpr std::array<std::string_view, 19> kNames = {
      ".csv", ".dat", ".vti", ".vts", ".vtkhdf", ".hdf",  ".ply",     ".off", ".xyz", ".obj",
      ".stl", ".vtp", ".png", ".svg", ".html",   ".json", ".graphml", ".swc", ".glb"};
  return kNames[static_cast<std::size_t>(format)];
}

}  // namespace affskel::core
