#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace affskel::client {

enum class FileFormat { kCsv, kDat, kVtkHdf, kPly, kOff, kXyz, kObj, kStl, kPng, kSvg, kHtml };

/// What can be written as which formats.
std::span<const FileFormat> field_formats();       // csv dat vtkhdf
std::span<const FileFormat> divergence_formats();  // csv dat vtkhdf
std::span<const FileFormat> skeleton_formats();    // csv ply off xyz
std::span<const FileFormat> surface_formats();     // off ply obj stl
std::span<const FileFormat> picture_formats();     // png
std::span<const FileFormat> page_formats();        // html

/// With the dot, e.g. ".csv".
std::string_view extension_of(FileFormat format);

/// The file's extension with the dot, in lower case; empty without one.
std::string lower_extension(const std::filesystem::path& file);

/// The format that the file's extension (in any case) stands for, if it is one of `possible`.
/// @throws ClientError kUsage naming the possible extensions.
FileFormat choose_format(const std::filesystem::path& file, std::span<const FileFormat> possible,
                         const std::string& what);

}  // namespace affskel::client
