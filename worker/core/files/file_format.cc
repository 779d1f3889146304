#include "core/files/file_format.h"

#include <array>
#include <cstddef>

namespace affskel::core {
namespace {

constexpr std::array kField = {FileFormat::kCsv, FileFormat::kDat,    FileFormat::kVti,
                               FileFormat::kVts, FileFormat::kVtkHdf, FileFormat::kHdf};
constexpr std::array kSkeleton = {FileFormat::kCsv, FileFormat::kPly, FileFormat::kOff, FileFormat::kXyz,
                                  FileFormat::kVtp};
constexpr std::array kSurface = {FileFormat::kOff, FileFormat::kPly, FileFormat::kObj, FileFormat::kStl,
                                 FileFormat::kVtp};
constexpr std::array kCurve = {FileFormat::kVtp,     FileFormat::kObj, FileFormat::kPly, FileFormat::kJson,
                               FileFormat::kGraphMl, FileFormat::kSwc, FileFormat::kGlb};

}  // namespace

std::span<const FileFormat> field_formats() {
  return kField;
}

std::span<const FileFormat> skeleton_formats() {
  return kSkeleton;
}

std::span<const FileFormat> surface_formats() {
  return kSurface;
}

std::span<const FileFormat> curve_formats() {
  return kCurve;
}

std::string_view extension_of(FileFormat format) {
  constexpr std::array<std::string_view, 19> kNames = {
      ".csv", ".dat", ".vti", ".vts", ".vtkhdf", ".hdf",  ".ply",     ".off", ".xyz", ".obj",
      ".stl", ".vtp", ".png", ".svg", ".html",   ".json", ".graphml", ".swc", ".glb"};
  return kNames[static_cast<std::size_t>(format)];
}

}  // namespace affskel::core
